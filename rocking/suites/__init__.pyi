from .hazard import annual_rate as annual_rate
from .outcomes import record_amplification as record_amplification
from .pulse_fit import PulseFit as PulseFit
from .pulse_fit import fit_pulse as fit_pulse
from .sensitivity import suite_sensitivity as suite_sensitivity
