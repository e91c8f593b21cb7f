#!/usr/bin/env python3
"""The expected trace of the ALD example, from a model of the process.

The model is written from the description of the reactor (README.md), not from the rungs, and
knows nothing of ladder: it has four modes and a list of six steps. It states the two delays
that a scanned controller adds, each of one scan, and why they are there. Two answers of
independent origin, this one and the compiled program's, must be equal in every cell.

    python3 expected.py            writes expected.csv
    python3 expected.py --check    exit code 1 when expected.csv differs

Python 3 and its standard library, nothing else.
"""

import csv
import sys
from pathlib import Path

HERE = Path(__file__).parent
INPUTS = ["Start", "Stop", "TP1", "TR", "Pressure_Switch", "Atmosphere", "heateron"]
OUTPUTS = ["SV1", "SV4", "VV1", "VV2", "heaterson", "reactorheater", "mfcwater"]
PERIOD_MS = 1
CYCLES = 3

# One deposition cycle: the valve that is open, and for how long.
STEPS = [("SV1", 20), (None, 1), ("VV1", 60), ("SV4", 20), (None, 1), ("VV2", 65)]


class Reactor:
    """One scan after another: `scan` takes the time and the inputs, and gives the outputs."""

    def __init__(self):
        self.mode = "rest"  # rest, pumping, depositing, venting
        self.nitrogen = False
        self.start_before = True  # a Start held at power-up is no start
        self.step = None  # index into STEPS
        self.step_end_ms = 0
        self.cycles_done = 0

    def scan(self, now_ms, inputs):
        self.supervise(inputs)
        if self.mode == "depositing":
            self.deposit(now_ms)
        return self.outputs(inputs)

    def supervise(self, inputs):
        pressed = inputs["Start"] and not self.start_before
        self.start_before = inputs["Start"]
        if self.mode == "rest" and pressed:
            self.cycles_done = 0
            if inputs["Stop"]:
                self.mode = "pumping"
        if self.mode in ("pumping", "depositing") and self.must_end(inputs):
            self.mode = "venting"
            self.step = None
        if self.mode in ("pumping", "depositing") and inputs["Pressure_Switch"]:
            self.nitrogen = True
        if self.mode == "venting":
            self.nitrogen = not inputs["Atmosphere"]
            if inputs["Atmosphere"]:
                self.mode = "rest"
        at_set_point = inputs["TP1"] and inputs["TR"]
        if self.mode == "pumping" and self.nitrogen and at_set_point:
            self.mode = "depositing"

    def must_end(self, inputs):
        # First delay: the cycles are counted after the supervision has run in a scan, so the
        # batch ends in the scan after the last count. Stop is seen at once.
        return not inputs["Stop"] or self.cycles_done >= CYCLES

    def deposit(self, now_ms):
        if self.step is None:
            self.begin(0, now_ms)
        # A step begins in the scan in which the step before it ends.
        while self.step is not None and now_ms >= self.step_end_ms:
            if self.step + 1 < len(STEPS):
                self.begin(self.step + 1, now_ms)
            else:
                # Second delay: a step list is scanned from top to bottom once, so its first
                # step follows its last one in the next scan.
                self.cycles_done += 1
                self.step = None

    def begin(self, step, now_ms):
        self.step = step
        self.step_end_ms = now_ms + STEPS[step][1]

    def outputs(self, inputs):
        running = self.mode in ("pumping", "depositing")
        valve = None if self.step is None else STEPS[self.step][0]
        pumping = self.mode == "pumping"
        return {
            "SV1": valve == "SV1",
            "SV4": valve == "SV4",
            "VV1": pumping or valve == "VV1",
            "VV2": pumping or valve == "VV2",
            "heaterson": running and inputs["heateron"],
            "reactorheater": running,
            "mfcwater": self.nitrogen,
        }


def read_stimulus():
    """Rows of (time, changed inputs), in the order of time."""
    with open(HERE / "stimulus.csv", newline="") as file:
        for row in csv.DictReader(file):
            cells = {name: row[name] == "1" for name in INPUTS if row[name] != ""}
            yield int(row["t_ms"]), cells


def trace():
    """The lines of expected.csv: the first scan, and every scan in which a signal changed."""
    rows = list(read_stimulus())
    inputs = dict.fromkeys(INPUTS, False)
    reactor = Reactor()
    before = None
    yield ",".join(["t_ms", *INPUTS, *OUTPUTS])
    for now_ms in range(0, rows[-1][0] + PERIOD_MS, PERIOD_MS):
        while rows and rows[0][0] <= now_ms:
            inputs.update(rows.pop(0)[1])
        signals = {**inputs, **reactor.scan(now_ms, inputs)}
        if signals != before:
            yield ",".join([str(now_ms), *(str(int(value)) for value in signals.values())])
        before = signals


def main():
    text = "".join(line + "\n" for line in trace())
    path = HERE / "expected.csv"
    if sys.argv[1:] == ["--check"]:
        if path.read_text() != text:
            sys.exit("expected.csv is not what expected.py gives")
    else:
        path.write_text(text)


if __name__ == "__main__":
    main()
