from .files import write_fragility as write_fragility
from .hazard import annual_rate as annual_rate
from .hazard_files import read_hazard as read_hazard
from .nrml import write_nrml as write_nrml
from .outcomes import record_amplification as record_amplification
from .pulse_fit import PulseFit as PulseFit
from .pulse_fit import fit_pulse as fit_pulse
from .sensitivity import suite_sensitivity as suite_sensitivity
