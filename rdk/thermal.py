"""Enclosure temperature: one node in steady state that gains heat inside and from the sun and loses it by radiation.

Gilmore (2002). No conduction, no internal gradient, no time constant; the lunar surface and the sky act through one
effective sink temperature. Good for a survival flag, not for a thermal design.
"""
import numpy as np

STEFAN_BOLTZMANN = 5.670374419e-8                        # W m-2 K-4, exact; scipy.constants is slow to load
ZERO_CELSIUS = 273.15


def enclosure_area(chassis_mass_kg, base_m2=0.05, coefficient_m2=0.02):
    """Radiating area of the warm enclosure.

    Parameters
    ----------
    chassis_mass_kg : float or ndarray
        m_c in kg.
    base_m2, coefficient_m2 : float or ndarray
        A_r = base + coefficient * m_c^(2/3), in m2 with the mass in kilograms.

    Returns
    -------
    float or ndarray
        A_r in m2.
    """
    return base_m2 + coefficient_m2 * np.cbrt(chassis_mass_kg) ** 2


def absorbed_sunlight(latitude_deg, area_m2, *, absorptivity=0.3, sunlit_fraction=0.25, solar_constant_w_m2=1361.0):
    """Sunlight that the enclosure absorbs at noon: alpha S_0 cos(latitude) times the sunlit part of its area, in W."""
    return (absorptivity * solar_constant_w_m2 * np.maximum(np.cos(np.radians(latitude_deg)), 0.0) * sunlit_fraction
            * area_m2)


def node_temperature(heat_w, area_m2, sink_temperature_k, *, emissivity=0.85):
    """Equilibrium temperature at which the node radiates what it gains, eq. thermal-node.

    Parameters
    ----------
    heat_w : float or ndarray
        Q_in: absorbed sunlight, dissipation and heaters, in W, zero or more.
    area_m2 : float or ndarray
        Radiating area in m2.
    sink_temperature_k : float or ndarray
        Effective temperature of the surroundings in kelvin; their infrared is in this term.
    emissivity : float or ndarray
        Infrared emissivity, 0 to 1.

    Returns
    -------
    float or ndarray
        Temperature in degrees Celsius: (T_sink^4 + Q / (eps sigma A))^(1/4).

    Examples
    --------
    >>> f"{node_temperature(0.0, 0.1, 100.0):.2f} degC"
    '-173.15 degC'
    """
    fourth_power = np.asarray(sink_temperature_k, float) ** 4 + heat_w / (emissivity * STEFAN_BOLTZMANN * area_m2)
    return np.sqrt(np.sqrt(fourth_power)) - ZERO_CELSIUS
