from . import closed_form as closed_form
from . import groups as groups
from . import orientation as orientation
from .block import Block as Block
from .boundary import Thresholds as Thresholds
from .boundary import critical_amplitude as critical_amplitude
from .boundary import overturning_boundary as overturning_boundary
from .errors import DatasetError as DatasetError
from .errors import InvalidArgumentError as InvalidArgumentError
from .errors import OutsideCubeError as OutsideCubeError
from .lookup import Cube as Cube
from .lookup import open_cube as open_cube
from .pulses import PULSE_NAMES as PULSE_NAMES
from .pulses import get_pulse as get_pulse
from .response import Outcome as Outcome
from .response import Response as Response
from .solve import peak_response as peak_response
from .solve import time_history as time_history

__version__: str
