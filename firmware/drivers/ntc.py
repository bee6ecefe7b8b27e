"""A 10 kohm thermistor (beta 3950) to ground under a 10 kohm pull-up, read by a 16-bit scaled ADC.

Valid from -20 to 130 C within 0.5 C: linear between table rows, which the test computes anew from the beta equation.
"""

LOWEST_DECIDEGC = -200
ROW_DECIDEGC = 100
TABLE = (59855, 55932, 50511, 43816, 36454, 29202, 22706, 17306, 13049, 9807, 7387, 5596, 4273, 3293, 2563, 2015)
OPEN_DECIDEGC = -9999  # no thermistor: the input sits at its rail
SHORT_DECIDEGC = 9999


def decidegc(reading: int) -> int:
    """Return the temperature, OPEN_DECIDEGC or SHORT_DECIDEGC."""
    if reading > TABLE[0]:
        return OPEN_DECIDEGC
    if reading < TABLE[-1]:
        return SHORT_DECIDEGC
    row = 1
    while reading < TABLE[row]:
        row += 1
    warmer = TABLE[row - 1] - reading
    return LOWEST_DECIDEGC + ROW_DECIDEGC * (row - 1) + ROW_DECIDEGC * warmer // (TABLE[row - 1] - TABLE[row])
