#!/usr/bin/python3
"""Reads snapshots with h5py alone, by what src/store/snapshot.h promises.

    snapshots_h5py.py PLAIN PACKED COLLIDE     three runs of snapshots.sh

Prints `ok NAME` or `FAIL NAME: why` lines.
"""
import glob
import sys
import zlib

import h5py
import numpy as np

FIELDS = {
    "id": ("1", "<i8", 1),
    "position": ("m", "<f8", 3),
    "radius": ("m", "<f8", 1),
    "velocity": ("m/s", "<f8", 3),
    "angular_velocity": ("rad/s", "<f8", 3),
    "force": ("N", "<f8", 3),
    "material": ("1", "<i4", 1),
    "group": ("1", "<i4", 1),
}


class Test:
    """One named result: the first thing that is wrong, if any."""

    def __init__(self, name):
        self.name, self.why = name, None

    def expect(self, condition, why):
        if not condition and self.why is None:
            self.why = why

    def print(self):
        print(f"ok {self.name}" if self.why is None else f"FAIL {self.name}: {self.why}")


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def files(run):
    return [h5py.File(path, "r") for path in sorted(glob.glob(f"{run}/snapshots/step_*.h5"))]


def check_layout(run):
    test = Test("h5py: fields, units, times, names")
    all_files = files(run)
    steps = [file["run"].attrs["step"] for file in all_files]
    test.expect(steps == list(range(0, 1001, 50)), f"steps {steps}")
    for file in all_files:
        attrs = file["run"].attrs
        test.expect(attrs["time"] == attrs["step"] * attrs["dt"] and text(attrs["time_unit"]) == "s", "time")
        test.expect(set(file["spheres"]) == set(FIELDS), f"fields {sorted(file['spheres'])}")
        for name, (unit, kind, width) in FIELDS.items():
            data = file["spheres"][name]
            n = attrs["n_spheres"]
            test.expect(data.shape == ((n,) if width == 1 else (n, width)), f"{name} is {data}")
            test.expect(data.dtype == np.dtype(kind), f"{name} is {data}")
            test.expect(text(data.attrs["unit"]) == unit and data.attrs["description"], f"{name} is not described")
            sums = [zlib.crc32(data[i : i + 256].tobytes()) for i in range(0, n, 256)]
            test.expect(file["checksums/spheres"][name][()].tolist() == sums, f"checksums of {name}")
        test.expect((np.diff(file["spheres/id"][()]) > 0).all(), "ids are out of order")
    names = text(all_files[0]["spheres/material"].attrs["names"]).split("\n")[:-1]
    test.expect(names == ["ore", "rubber", "steel"], f"materials {names}")
    names = text(all_files[0]["spheres/group"].attrs["names"]).split("\n")[:-1]
    test.expect(names == ["scattered", "above", "beside"], f"groups {names}")
    counts = [file["run"].attrs["n_spheres"] for file in all_files]
    test.expect(counts[0] == 172 and counts[-1] == 149, f"spheres that left are still there: {counts}")
    test.print()


def check_state(run):
    """Places are those of the checkpoint of the same step; velocities lie between half steps."""
    test = Test("h5py: places and velocities agree with checkpoints")
    for step in (200, 400, 600):
        with h5py.File(f"{run}/checkpoints/step_{step:012d}.h5") as state, h5py.File(
            f"{run}/snapshots/step_{step:012d}.h5"
        ) as file:
            one, other = state["spheres"], file["spheres"]
            for name in ("radius", "material", "group"):
                same = dict(zip(one["id"][()], one[name][()]))
                test.expect(all(same[i] == v for i, v in zip(other["id"][()], other[name][()])), name)
            keep = np.isin(one["id"][()], other["id"][()])  # removed at the beginning of this step
            test.expect((one["position"][()][keep] == other["position"][()]).all(), f"position at step {step}")
            dt, g, damping = file["run"].attrs["dt"], np.array([0.5, -0.3, -9.81]), 0.7
            density = np.array([2400, 1100])[other["material"][()]]
            mass = density * 4 / 3 * np.pi * other["radius"][()] ** 3
            pull = other["force"][()] / mass[:, None] + g
            half = one["velocity"][()][keep]
            expected = (half + 0.5 * dt * pull) / (1 + 0.5 * dt * damping)
            test.expect(np.allclose(other["velocity"][()], expected, rtol=1e-12, atol=1e-12), f"velocity at {step}")
    test.print()


def check_bodies(run):
    test = Test("h5py: bodies; what is unchanged is written once")
    first, *rest = files(run)
    box = first["bodies/trough/points"][()]
    test.expect(box.min(axis=0).tolist() == [-0.5, -0.5, 0] and box.max(axis=0).tolist() == [0.8, 0.5, 1.5], "trough")
    for file in (first, *rest):
        time = file["run"].attrs["time"]
        test.expect(set(file["bodies"]) == {"trough", "paddle", "plate"}, f"bodies {set(file['bodies'])}")
        for name, body in file["bodies"].items():
            test.expect(text(body.attrs["material"]) == "steel", f"material of {name}")
            test.expect(body["triangles"].shape[1] == 3 and body["triangles"][()].max() < len(body["points"]), name)
            where = body["points"].file.filename
            test.expect(where.endswith(f"step_{body.attrs['points_step']:012d}.h5"), f"{name} is in {where}")
            raw = body["points"][()].tobytes()
            test.expect(body["points"].attrs["checksum"] == zlib.crc32(raw), f"checksum of {name}")
        test.expect(file["bodies/trough"].attrs["points_step"] == 0, "the trough is written again")
        moved = file["bodies/plate/points"][()] - first["bodies/plate/points"][()]
        lasted = min(max(time, 0.01), 0.07) - 0.01
        test.expect(np.allclose(moved, [1.5 * lasted, 0.2 * lasted, 0], atol=1e-14), f"plate at {time} s")
    for step, expected in ((50, 0), (100, 0), (150, 150), (700, 700), (750, 700), (1000, 700)):
        with h5py.File(f"{run}/snapshots/step_{step:012d}.h5") as file:
            found = file["bodies/plate"].attrs["points_step"]
            test.expect(found == expected, f"the plate of step {step} is that of step {found}")
    test.print()


def check_packed(plain, packed):
    test = Test("h5py: packed in single precision, the same rounded")
    for one, other in zip(files(plain), files(packed)):
        for name in FIELDS:
            exact, rounded = one["spheres"][name], other["spheres"][name]
            test.expect(rounded.compression == "gzip" and rounded.shuffle, f"{name} is not packed")
            expected = exact[()].astype("<f4") if exact.dtype.kind == "f" else exact[()]
            test.expect(rounded.dtype == expected.dtype and (rounded[()] == expected).all(), name)
        test.expect((one["bodies/paddle/points"][()] == other["bodies/paddle/points"][()]).all(), "paddle")
    test.print()


def check_contacts(run):
    """Without bodies and with the ledger a sphere's force is what its contacts add up to."""
    test = Test("h5py: contacts add up to the spheres' forces, and lie on both")
    most = 0
    for file in files(run):
        spheres, contacts = file["spheres"], file["contacts"]
        ids, place, radius = (spheres[name][()] for name in ("id", "position", "radius"))
        first, second = (np.searchsorted(ids, contacts[name][()]) for name in ("first_id", "second_id"))
        force, point = contacts["force"][()], contacts["position"][()]
        total = np.zeros_like(place)
        np.add.at(total, second, force)
        np.add.at(total, first, -force)
        scale = np.abs(force).max(initial=1e-300)
        error = np.abs(total - spheres["force"][()]).max()
        test.expect(error <= 1e-9 * scale, f"step {file['run'].attrs['step']}: {error} of {scale} N")
        for i in (first, second):
            depth = radius[i] - np.linalg.norm(point - place[i], axis=1)
            test.expect((depth >= 0).all() and (depth < 0.2 * radius[i]).all(), "a contact is not on its sphere")
        test.expect((contacts["first_id"][()] < contacts["second_id"][()]).all(), "order of contacts")
        most = max(most, len(first))
    test.expect(most > 20, f"only {most} contacts: this run shows nothing")
    test.print()


def main():
    plain, packed, collide = sys.argv[1:]
    check_layout(plain)
    check_state(plain)
    check_bodies(plain)
    check_packed(plain, packed)
    check_contacts(collide)


main()
