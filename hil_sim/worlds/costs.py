"""What an access to the hardware costs in virtual time, the same in every world.

Computing costs nothing; only these do, so that a loop that waits for the clock or a bus makes progress. Bus transfers
cost nine bits a byte at the bus's own rate. ASSUMED: the order of magnitude of the rp2 port at 125 MHz.
"""

TICKS_US = 1
PIN_US = 1
ADC_US = 3
UART_US = 3
SPI_US = 2  # and eight bits a byte
PWM_US = 2
WATCHDOG_US = 1
BOOT_US = 20_000  # from reset to the first statement of boot.py
TICKS_PERIOD = 1 << 30  # ticks_ms and ticks_us wrap here, as on boards
WATCHDOG_MAX_MS = 8388
