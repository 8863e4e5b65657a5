from .distribution import distribution as distribution
from .files import write_fragility as write_fragility
from .outcomes import record_amplification as record_amplification
from .pulse_fit import PulseFit as PulseFit
from .pulse_fit import fit_pulse as fit_pulse
from .sensitivity import suite_sensitivity as suite_sensitivity
from .spectrum_volume import spectrum_volume as spectrum_volume
