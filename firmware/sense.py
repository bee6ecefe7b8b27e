"""What the firmware knows of the robot: supply, board, and an estimate of each coil's heat.

A coil's temperature is estimated from the power it is given: sensible heat, loss to the air and the latent heat of
its phase change between fixed temperatures (stress moves them on the real coil; the energy is the same). The heat
budget is the energy taken, leaking away with its own time constant. All integers: mK, uW, nJ, ms.
"""

from array import array

BOARD_MIN_DECIDEGC = -200  # what a thermistor in order reads on a board in use
BOARD_MAX_DECIDEGC = 850
STRAY_MA = 25  # what the monitor may read when nothing is on
AMBIENT_LEAST_DECIDEGC = 200  # the estimates reckon with no colder air: a thermistor may have drifted
NOMINAL_PERMILLE = 1000
NEAR_PERMILLE = 970  # a resistance so near to the profile's, or above it, counts as the profile's
STALE_STEPS = 4  # after a sense slot: then the second conversion, of 9.8 ms, has ended


class Sense:
    """Readings of the chips and the estimate for every coil."""

    def __init__(self, board, monitor, count: int, profile) -> None:
        self.supply_mv = 0
        self.current_ma = 0
        self.current_fresh = False  # whether it was read in this control step
        self.board_decidegc = 250  # as read: the guard judges it
        self._ambient_decidegc = 250  # the last reading that can be, or the least that is believed
        self.temperature_millidegc = array("i", [25_000] * count)  # cold, until power or a reset says otherwise
        self.heat_uj = array("i", [0] * count)  # taken and not yet leaked away
        self.hottest = -1  # among the coils that are on, the one with the highest estimate; -1: none is on
        self.fullest = -1  # and the one nearest to its heat budget
        self._weight_permille = array("H", [NOMINAL_PERMILLE] * count)  # power, of what the profile's coil would take
        self._martensite_permille = array("i", [1000] * count)
        self._rest_nj = array("i", [0] * count)
        self._seen_ms = array("i", [0] * count)
        self.board_offset_decidegc = 0  # added to what the thermistor reads
        self._board = board
        self._monitor = monitor
        self._coil = coil = profile.coil
        self._nominal_mv = profile.supply.nominal_mv
        self._latent_heating = _latent_uj_per_k(coil, coil.as_millidegc, coil.af_millidegc)
        self._latent_cooling = _latent_uj_per_k(coil, coil.mf_millidegc, coil.ms_millidegc)
        self._change_millidegc = min(coil.as_millidegc, coil.mf_millidegc)  # below it no phase changes
        self._austenite_millidegc = max(coil.af_millidegc, coil.ms_millidegc)  # from it on there is no martensite
        self._count = count
        self._turns = max(1, count)
        self._turn = 0
        self._stale = 0
        self._updated_ms = 0
        self._full_uw = 0

    def read(self) -> None:
        """Read one sensor in its turn; OSError when the monitor does not answer."""
        self._turn = (self._turn + 1) & 63
        self.current_fresh = False
        if self._turn == 0:
            self._read_board()
        elif self._stale:
            self._stale -= 1
        elif self._turn & 1:
            self.current_ma = self._monitor.current_ma()
            self.current_fresh = True
        elif self._turn & 2:
            self._read_supply()

    def disturbed(self) -> None:
        """Read nothing from the monitor before its averages are of the coils' mean current again."""
        self._stale = STALE_STEPS

    def pulse(self, channel: int, more_permille: int, time_us: int) -> None:
        """Add the energy of a pulse at so much more than the duty that was ordered."""
        energy_uj = self._weighed(channel, self._full_uw) // 1000 * time_us // 1000 * more_permille // 1000
        self.heat_uj[channel] += energy_uj
        self._rest_nj[channel] += energy_uj * 1000

    def weigh(self, channel: int, mohm: int) -> None:
        """Reckon with more power in a coil that was found to have less resistance than the profile says."""
        nominal_mohm, wiring_mohm = self._coil.resistance_mohm, self._coil.wiring_mohm
        self._weight_permille[channel] = NOMINAL_PERMILLE
        if mohm < nominal_mohm // 1000 * NEAR_PERMILLE:
            nominal_uw = full_power_uw(self._nominal_mv, nominal_mohm, wiring_mohm)
            self._weight_permille[channel] = full_power_uw(self._nominal_mv, mohm, wiring_mohm) // (nominal_uw // 1000)

    def assume_hot(self) -> None:
        """Take every coil as just below its trip, its budget spent: what a reset forgot may be so."""
        for channel in range(self._count):
            self.temperature_millidegc[channel] = self._coil.trip_decidegc * 100
            self.heat_uj[channel] = self._coil.heat_budget_mj * 1000
            self._martensite_permille[channel] = 0

    def begin_supply(self) -> None:
        """Read every sensor now; OSError when the monitor does not answer."""
        self.current_ma = self._monitor.current_ma()
        self._read_board()
        self._read_supply()

    def update(self, now_ms: int, on_mask: int, duty_permille: array) -> None:
        """Bring the estimates up to now, with the duties that have held since the last call.

        Coils that are on are brought up at each step, the others in turn.
        """
        turn = self._turn % self._turns
        if turn < self._count and not on_mask >> turn & 1:
            self._heat(turn, now_ms, 0)
        updated_ms, tenth_uw = self._updated_ms, self._full_uw // 10
        hottest = fullest = -1
        channel = 0
        while on_mask:
            if on_mask & 1:
                if self._seen_ms[channel] != updated_ms:
                    self._heat(channel, updated_ms, 0)  # it was off until then
                self._heat(channel, now_ms, self._weighed(channel, tenth_uw * duty_permille[channel] // 100))
                if hottest < 0 or self.temperature_millidegc[channel] > self.temperature_millidegc[hottest]:
                    hottest = channel
                if fullest < 0 or self.heat_uj[channel] > self.heat_uj[fullest]:
                    fullest = channel
            on_mask >>= 1
            channel += 1
        self.hottest = hottest
        self.fullest = fullest
        self._updated_ms = now_ms

    def _weighed(self, channel: int, power_uw: int) -> int:
        weight = self._weight_permille[channel]
        return power_uw if weight == NOMINAL_PERMILLE else power_uw // 1000 * weight

    def _read_board(self) -> None:
        read_decidegc = self._board.board_decidegc()
        self.board_decidegc = read_decidegc + self.board_offset_decidegc
        if BOARD_MIN_DECIDEGC <= self.board_decidegc <= BOARD_MAX_DECIDEGC:
            self._ambient_decidegc = max(read_decidegc, self.board_decidegc, AMBIENT_LEAST_DECIDEGC)

    def _read_supply(self) -> None:
        self.supply_mv = self._monitor.voltage_mv()
        self._full_uw = full_power_uw(self.supply_mv, self._coil.resistance_mohm, self._coil.wiring_mohm)

    def _heat(self, channel: int, now_ms: int, power_uw: int) -> None:
        """Move one estimate up to now at constant power."""
        passed_ms = now_ms - self._seen_ms[channel]
        if not passed_ms:
            return
        self._seen_ms[channel] = now_ms
        coil = self._coil
        heat_uj = self.heat_uj[channel]
        heat_uj += power_uw * passed_ms // 1000 - heat_uj * passed_ms // coil.heat_leak_ms
        self.heat_uj[channel] = heat_uj if heat_uj > 0 else 0
        t = self.temperature_millidegc[channel]
        loss_uw = (t // 100 - self._ambient_decidegc) * coil.loss_uw_per_k // 10
        energy_nj = (power_uw - loss_uw) * passed_ms + self._rest_nj[channel]
        capacity = coil.heat_capacity_uj_per_k
        if self._change_millidegc <= t <= self._austenite_millidegc:
            capacity += self._latent(channel, t, energy_nj)
        moved = energy_nj // capacity
        self._rest_nj[channel] = energy_nj - moved * capacity
        t += moved
        self.temperature_millidegc[channel] = t
        if t <= coil.mf_millidegc:
            self._martensite_permille[channel] = 1000
        elif t >= self._austenite_millidegc:
            self._martensite_permille[channel] = 0
        else:
            self._transform(channel, t)

    def _latent(self, channel: int, t: int, energy_nj: int) -> int:
        """Return the apparent heat capacity of the phase change where one is going on.

        A coil that was cooled in between and is heated again takes no latent heat before it is back on its heating
        line: what has transformed does not transform twice. On cooling too much is given, so that the estimate errs
        to the hot side.
        """
        coil = self._coil
        martensite = self._martensite_permille[channel]
        if energy_nj > 0 and coil.as_millidegc <= t < coil.af_millidegc:
            on_line = 1000 * (coil.af_millidegc - t) // (coil.af_millidegc - coil.as_millidegc)
            return self._latent_heating if martensite >= on_line else 0
        if energy_nj < 0 and coil.mf_millidegc < t <= coil.ms_millidegc and martensite < 1000:
            return self._latent_cooling
        return 0

    def _transform(self, channel: int, t: int) -> None:
        """Hold the martensite fraction between its heating and cooling lines, where they are."""
        coil = self._coil
        most = 1000 * (coil.af_millidegc - t) // (coil.af_millidegc - coil.as_millidegc)
        least = 1000 * (coil.ms_millidegc - t) // (coil.ms_millidegc - coil.mf_millidegc)
        martensite = self._martensite_permille[channel]
        martensite = most if martensite > most else martensite
        martensite = least if martensite < least else martensite
        self._martensite_permille[channel] = 0 if martensite < 0 else martensite


def _latent_uj_per_k(coil, begin_millidegc: int, end_millidegc: int) -> int:
    """Return the latent heat spread over a phase change between two temperatures."""
    return coil.latent_uj * 10 // ((end_millidegc - begin_millidegc) // 100)  # below 2**30


def full_power_uw(supply_mv: int, resistance_mohm: int, wiring_mohm: int) -> int:
    """Return the power in a coil that is on all the time: I^2 R with I = U / (R + wiring)."""
    current_ma = supply_mv * 1000 // (resistance_mohm + wiring_mohm)
    return current_ma * current_ma // 100 * resistance_mohm // 10
