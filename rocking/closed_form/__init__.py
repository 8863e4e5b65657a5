"""Closed forms of sections 3 and 4 of the paper for the slender block under one full sine, and related conditions.

Arguments are the dimensionless groups of the paper: amplitude a = a_g/(g alpha) = 1/slenderness, frequency_ratio
omega = omega_g/p and restitution eta; times are tau = p t from uplift. All arguments broadcast. Results are nan where
the event does not occur.
"""

from rocking.closed_form.ad_hoc import EXPANSION_TIME as EXPANSION_TIME
from rocking.closed_form.ad_hoc import ad_hoc_impact_time as ad_hoc_impact_time
from rocking.closed_form.ad_hoc import ad_hoc_margin as ad_hoc_margin
from rocking.closed_form.ad_hoc import ad_hoc_residual as ad_hoc_residual
from rocking.closed_form.ad_hoc import ad_hoc_sine as ad_hoc_sine
from rocking.closed_form.ad_hoc import exponential_series as exponential_series
from rocking.closed_form.ad_hoc import kappa_lambda as kappa_lambda
from rocking.closed_form.ad_hoc import semi_analytical_amplitudes as semi_analytical_amplitudes
from rocking.closed_form.ad_hoc import sine_series as sine_series
from rocking.closed_form.ad_hoc import within_pulse as within_pulse
from rocking.closed_form.case_1_1 import amplitude_of_impact_time as amplitude_of_impact_time
from rocking.closed_form.case_1_1 import case_1_1_amplitudes as case_1_1_amplitudes
from rocking.closed_form.case_1_1 import case_1_1_end as case_1_1_end
from rocking.closed_form.case_1_1 import case_1_1_impact_time as case_1_1_impact_time
from rocking.closed_form.case_1_1 import case_1_1_impact_velocity as case_1_1_impact_velocity
from rocking.closed_form.case_1_1 import case_1_1_margin as case_1_1_margin
from rocking.closed_form.case_1_1 import overturning_condition as overturning_condition
from rocking.closed_form.case_1_2 import case_1_2_amplitudes as case_1_2_amplitudes
from rocking.closed_form.case_1_2 import case_1_2_impact_time as case_1_2_impact_time
from rocking.closed_form.case_1_2 import case_1_2_impact_velocity as case_1_2_impact_velocity
from rocking.closed_form.case_1_2 import case_1_2_margin as case_1_2_margin
from rocking.closed_form.case_1_2 import case_1_2_residual as case_1_2_residual
from rocking.closed_form.case_1_2 import condition_3_18 as condition_3_18
from rocking.closed_form.case_1_2 import free_velocity as free_velocity
from rocking.closed_form.case_1_2 import impact_velocity_squared as impact_velocity_squared
from rocking.closed_form.case_2 import case_2_amplitude as case_2_amplitude
from rocking.closed_form.case_2 import case_2_margin as case_2_margin
from rocking.closed_form.case_2 import growing_coefficient as growing_coefficient
from rocking.closed_form.coefficients import after_pulse_coefficients as after_pulse_coefficients
from rocking.closed_form.coefficients import coefficients as coefficients
from rocking.closed_form.coefficients import d0_star as d0_star
from rocking.closed_form.coefficients import d0_star_expanded as d0_star_expanded
from rocking.closed_form.coefficients import integration_constants as integration_constants
from rocking.closed_form.coefficients import pulse_end as pulse_end
from rocking.closed_form.coefficients import uplift_phase as uplift_phase
from rocking.closed_form.first_arc import angular_velocity as angular_velocity
from rocking.closed_form.first_arc import printed_rotation as printed_rotation
from rocking.closed_form.first_arc import rotation as rotation
from rocking.closed_form.first_arc import state_at_pulse_end as state_at_pulse_end
from rocking.closed_form.impact_sequences import Impact as Impact
from rocking.closed_form.impact_sequences import impacts_in_pulse as impacts_in_pulse
from rocking.closed_form.impact_sequences import island_tip as island_tip
from rocking.closed_form.impact_sequences import margin_after_impacts as margin_after_impacts
from rocking.closed_form.impact_sequences import overturning_interval as overturning_interval
from rocking.closed_form.interval import AmplitudeInterval as AmplitudeInterval
from rocking.closed_form.limit import limit_amplitude as limit_amplitude
from rocking.closed_form.limit import limit_margin as limit_margin
from rocking.closed_form.limit import limit_velocity as limit_velocity
from rocking.closed_form.no_impact import discounted_integral as discounted_integral
from rocking.closed_form.no_impact import first_uplift_phase as first_uplift_phase
from rocking.closed_form.no_impact import margin_after_impact as margin_after_impact
from rocking.closed_form.no_impact import margin_without_impact as margin_without_impact
from rocking.closed_form.overturning import OverturningAmplitudes as OverturningAmplitudes
from rocking.closed_form.overturning import overturning_amplitudes as overturning_amplitudes
from rocking.closed_form.peak import case_1_2_peak as case_1_2_peak
from rocking.closed_form.peak import case_1_2_peak_by_pulse as case_1_2_peak_by_pulse
from rocking.closed_form.peak import peak_of_velocity as peak_of_velocity
from rocking.closed_form.peak import scale_function as scale_function
from rocking.closed_form.peak import small_peak as small_peak
from rocking.closed_form.peak import small_peak_by_pulse as small_peak_by_pulse
from rocking.closed_form.published import cosine_amplitude as cosine_amplitude
from rocking.closed_form.published import half_sine_amplitude as half_sine_amplitude
from rocking.closed_form.published import rectangular_amplitude as rectangular_amplitude
from rocking.closed_form.transcendental import residual as residual
from rocking.closed_form.transcendental import rising_root as rising_root
