#!/usr/bin/env python3
"""Runs the ALD reactor from a shared library and prints a line whenever something changes.

    ald.py libALD_Reactor.so stimulus.csv
"""

import csv
import ctypes
import sys

NAME = "ALD_Reactor"
PERIOD_NS = 1_000_000


# The structs of ALD_Reactor.h.
class Inputs(ctypes.Structure):
    _fields_ = [(name, ctypes.c_bool) for name in
                ("Start", "Stop", "TP1", "TR", "Pressure_Switch", "Atmosphere", "heateron")]


class Outputs(ctypes.Structure):
    _fields_ = [(name, ctypes.c_bool) for name in
                ("SV1", "SV4", "VV1", "VV2", "heaterson", "reactorheater", "mfcwater")]


class Controller:
    """One controller: its state, inputs and outputs."""

    def __init__(self, path):
        library = ctypes.CDLL(path)
        for struct, what in ((Inputs, "inputs"), (Outputs, "outputs")):
            size = self.function(library, f"{what}_size", ctypes.c_size_t)()
            if size != ctypes.sizeof(struct):
                sys.exit(f"{path}: {what} take {size} bytes, not {ctypes.sizeof(struct)}")
        size = self.function(library, "state_size", ctypes.c_size_t)()
        # 64-bit words, because a state needs an alignment of 8.
        self.state = (ctypes.c_uint64 * (size // 8))()
        self.inputs, self.outputs = Inputs(), Outputs()
        state, inputs, outputs = (ctypes.c_void_p,) * 3
        self.run = self.function(library, "scan", ctypes.c_int, state, inputs, outputs, ctypes.c_uint64)
        self.fault_text = self.function(library, "fault_text", ctypes.c_char_p, ctypes.c_int)
        self.function(library, "init", None, state)(self.state)

    @staticmethod
    def function(library, name, result, *arguments):
        function = getattr(library, f"{NAME}_{name}")
        function.restype, function.argtypes = result, arguments
        return function

    def scan(self, now_ns):
        fault = self.run(self.state, ctypes.byref(self.inputs), ctypes.byref(self.outputs), now_ns)
        if fault:
            sys.exit(f"scan at {now_ns} ns: {self.fault_text(fault).decode()}")

    def values(self):
        structs = (self.inputs, self.outputs)
        return [int(getattr(s, name)) for s in structs for name, _ in s._fields_]


def main(library, stimulus):
    controller = Controller(library)
    with open(stimulus, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    names = [name for struct in (Inputs, Outputs) for name, _ in struct._fields_]
    print("t_ms", *names, sep=",")
    before = None
    for t_ms in range(int(rows[-1]["t_ms"]) + 1):
        while rows and int(rows[0]["t_ms"]) <= t_ms:
            for name, value in rows.pop(0).items():
                if name != "t_ms" and value:
                    setattr(controller.inputs, name, bool(int(value)))
        controller.scan(t_ms * PERIOD_NS)
        if controller.values() != before:
            before = controller.values()
            print(t_ms, *before, sep=",")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
