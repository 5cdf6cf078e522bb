#!/usr/bin/python3
"""What spheres do on shells, against theory and conservation.

    sheet_contact.py REST TURNED ROLL FREE SMOOTH     runs of sheet_contact.sh

Prints `ok NAME` or `FAIL NAME: why` lines.
"""
import glob
import math
import sys

import h5py
import numpy as np


class Test:
    """One named result: the first thing that is wrong, if any."""

    def __init__(self, name):
        self.name, self.why = name, None

    def near(self, what, value, expected, tolerance):
        if not abs(value - expected) <= tolerance and self.why is None:
            self.why = f"{what} is {value:.17g}, not {expected:.17g} within {tolerance:g}"

    def print(self):
        print(f"ok {self.name}" if self.why is None else f"FAIL {self.name}: {self.why}")


def states(run):
    return [h5py.File(path, "r") for path in sorted(glob.glob(f"{run}/checkpoints/*.h5"))]


def series(run, column):
    parts = [h5py.File(path, "r")["series"] for path in sorted(glob.glob(f"{run}/series/*.h5"))]
    return np.concatenate([part[column][()] for part in parts])


# ---------------------------------------------------------------------------------------- rest

RADIUS, PLATE, BLADE, EDGE = 0.02, 0.004, 0.001, 0.1
WEIGHT = 2500 * 4 / 3 * math.pi * RADIUS**3 * 9.81
STIFF = 4 / 3 / ((1 - 0.25**2) / 5e6 + (1 - 0.3**2) / 2e8) * math.sqrt(RADIUS)  # Hertz, N/m^1.5


def depth_on_plane():
    return (WEIGHT / STIFF) ** (2 / 3)


def force_on_edge(depth):
    """Of a plate so thick, edge-on: the pressure of (2.7) at the depth of the volume both share, on the edge's area."""
    height, n = RADIUS - depth, 2000
    wide = min(0.5 * BLADE, math.sqrt(RADIUS**2 - height**2))
    across = (np.arange(n) + 0.5) / n * 2 * wide - wide
    around2 = RADIUS**2 - across**2
    half = np.sqrt(around2 - height**2)
    area = 2 * half
    volume = around2 * np.arcsin(half / np.sqrt(around2)) - height * half
    area, volume = (x.sum() * 2 * wide / n for x in (area, volume))
    delta = math.sqrt(volume / math.pi / RADIUS)
    for _ in range(50):
        delta = math.sqrt(volume / math.pi / (RADIUS - delta / 3))
    return STIFF * delta**1.5 * area / (math.pi * delta * (2 * RADIUS - delta))


def depth_on_edge():
    low, high = 0.0, 0.5 * RADIUS
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if force_on_edge(middle) < WEIGHT else (low, middle)
    return low


def check_rest(run, turned):
    down, up = (states(name)[-1]["spheres/position"][()] for name in (run, turned))
    on_plane, on_edge = depth_on_plane(), depth_on_edge()
    test = Test("a sphere rests half the thickness above a shell, and as far below it")
    test.near("its height", down[0, 2], PLATE / 2 + RADIUS - on_plane, 1e-9 * on_plane)
    test.near("its height where weight points up", up[1, 2], -down[0, 2], 1e-15)
    test.near("how far it has gone aside", abs(down[0, :2] - (0.011, 0.007)).max(), 0, 1e-12)
    test.print()
    test = Test("a sphere rests on the edge of a shell")
    test.near("its height", down[2, 2], EDGE + RADIUS - on_edge, 1e-3 * on_edge)
    test.near("its depth beside that on a plane", on_edge / on_plane, 4.37, 0.01)
    test.near("how far it has gone aside", abs(down[2, :2] - (0.511, 0)).max(), 0, 1e-12)
    test.print()


# ---------------------------------------------------------------------------------------- roll


def check_roll(run):
    ball = {name: series(run, f"ball.velocity_{name}") for name in "xyz"}
    time, balance = series(run, "time"), series(run, "balance")
    before = (time > 0.1) & (time < 0.47)  # it is above the rim at .48 s
    energy = (series(run, "kinetic_translation") + series(run, "kinetic_rotation"))[0]
    test = Test("a ball rolls over quads, triangles, their seams and a rim")
    test.near("its speed before the rim", abs(ball["x"][before] - 0.25).max(), 0, 1e-13)
    test.near("its speed aside", abs(ball["y"][before] - 0.02).max(), 0, 1e-13)
    test.near("how much it jumps", abs(ball["z"][before]).max(), 0, 6e-5)  # that of the start
    test.near("what of its energy is lost or found", abs(balance).max() / energy, 0, 1e-7)
    test.near("its speed after the rim, which pushes it off", ball["x"][-1], 0.295, 0.01)
    test.near("how it falls then", (ball["z"][-1] - ball["z"][-21]) / (time[-1] - time[-21]), -9.81, 1e-9)
    test.print()


# ------------------------------------------------------------------------------------ momentum


def momenta(run, state):
    """Momentum and moment of momentum of the ball and the sheet: masses by (13.15)."""
    sheet = h5py.File(sorted(glob.glob(f"{run}/snapshots/step_*.h5"))[0])["solids/sheet"]
    places, corners = sheet["reference"][()], sheet["corners"][()][:, :4]
    mass, inertia, thickness = np.zeros(len(places)), np.zeros(len(places)), 0.004
    for nodes in corners:
        a, b = places[nodes[2]] - places[nodes[0]], places[nodes[3]] - places[nodes[1]]
        area = 0.5 * np.linalg.norm(np.cross(a, b))
        mass[nodes] += 4000 * thickness * area / 4
        inertia[nodes] += 4000 * thickness * area / 4 * max(thickness**2 / 12, area / 8)
    ball = 2500 * 4 / 3 * math.pi * RADIUS**3
    x, v, w = (state[f"spheres/{name}"][()][0] for name in ("position", "velocity", "angular_velocity"))
    y, u, o = (state[f"nodes/{name}"][()] for name in ("position", "velocity", "angular_velocity"))
    momentum = ball * v + (mass[:, None] * u).sum(0)
    moment = np.cross(x, ball * v) + 0.4 * ball * RADIUS**2 * w
    return momentum, moment + (np.cross(y, mass[:, None] * u) + inertia[:, None] * o).sum(0)


def check_free(run, smooth):
    ball = 2500 * 4 / 3 * math.pi * RADIUS**3
    x, v, w = np.array([[0.05, -0.03, 0.023], [0.8, 0.4, -1.5], [30, -20, 50]])
    before = ball * v, np.cross(x, ball * v) + 0.4 * ball * RADIUS**2 * w
    test = Test("a ball and a free shell keep their momentum")
    for name, most in ((run, 0.008), (smooth, 1e-4)):  # friction acts on the ball at R, not R - depth
        state = states(name)[-1]
        after = momenta(name, state)
        test.near("what is lost of it", abs(after[0] - before[0]).max() / np.linalg.norm(before[0]), 0, 1e-14)
        test.near("of its moment", np.linalg.norm(after[1] - before[1]) / np.linalg.norm(before[1]), 0, most)
        test.near("the ball's speed, far from what it was", float(state["spheres/velocity"][0, 2] > -0.7), 1, 0)
    test.print()


if __name__ == "__main__":
    check_rest(*sys.argv[1:3])
    check_roll(sys.argv[3])
    check_free(*sys.argv[4:6])
