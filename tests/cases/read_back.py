#!/usr/bin/python3
"""Reads a run's checkpoints and series with h5py alone, as a stranger would: counts, units, times,
order and checksums as src/store/checkpoint.h and series.h promise them.

    read_back.py RUN N_SPHERES DT EVERY     DT and EVERY (of the series) in s

Prints `ok NAME` or `FAIL NAME: why` lines.
"""
import glob
import os
import sys
import zlib

import h5py
import numpy as np

BLOCK_ROWS = 256

# Name: unit, type, components.
SPHERES = {
    "id": ("1", "<i8", 1),
    "order_cell": ("1", "<i8", 1),
    "position": ("m", "<f8", 3),
    "velocity": ("m/s", "<f8", 3),
    "angular_velocity": ("rad/s", "<f8", 3),
    "radius": ("m", "<f8", 1),
    "material": ("1", "<i4", 1),
    "group": ("1", "<i4", 1),
    "sides": ("1", "<i8", 1),
    "dissipated_friction": ("J", "<f8", 1),
    "dissipated_damping": ("J", "<f8", 1),
}
HISTORY = {
    "tangential_force": ("N", "<f8", 3),
    "contact_radius": ("m", "<f8", 1),
    "normal_velocity": ("m/s", "<f8", 1),
    "dashpot_force": ("N", "<f8", 3),
}
TABLES = {
    "spheres": SPHERES,
    "contacts": {"first_id": ("1", "<i8", 1), "second_id": ("1", "<i8", 1), **HISTORY},
    "facet_contacts": {"id": ("1", "<i8", 1), "body": ("1", "<i4", 1), "feature": ("1", "<i4", 1), **HISTORY},
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


def expect_described(test, data, unit):
    test.expect(text(data.attrs.get("unit", b"")) == unit, f"{data.name} is not in {unit}")
    test.expect(text(data.attrs.get("description", b"")) != "", f"{data.name} has no description")


def expect_table(test, file, name, n):
    for column, (unit, kind, width) in TABLES[name].items():
        data = file[name][column]
        shape = (n,) if width == 1 else (n, width)
        test.expect(data.shape == shape and data.dtype == np.dtype(kind), f"{data.name} is {data}")
        expect_described(test, data, unit)
    test.expect(set(file[name]) == set(TABLES[name]), f"/{name} holds {sorted(file[name])}")


def expect_checksums(test, file, name):
    for column in TABLES[name]:
        rows = file[name][column][()]
        sums = [zlib.crc32(rows[i : i + BLOCK_ROWS].tobytes()) for i in range(0, len(rows), BLOCK_ROWS)]
        stored = file["checksums"][name][column][()]
        test.expect(stored.tolist() == sums, f"checksums of /{name}/{column}")


def check_counts(file, n_spheres, dt):
    test, run = Test("checkpoint: counts, units, time"), file["run"].attrs
    test.expect(text(run["format"]) == "tremie checkpoint" and run["format_version"] == 5, "format")
    test.expect(run["n_spheres"] == n_spheres, f"{run['n_spheres']} spheres")
    test.expect(run["dt"] == dt and text(run["dt_unit"]) == "s", f"dt is {run['dt']}")
    test.expect(run["time"] == run["step"] * dt and text(run["time_unit"]) == "s", f"time is {run['time']}")
    for name, count in (("spheres", "n_spheres"), ("contacts", "n_contacts"), ("facet_contacts", "n_facet_contacts")):
        expect_table(test, file, name, run[count])
    test.expect(len(text(file["run/job"][()])) > 100, "no job in it")
    test.print()


def check_order(file):
    test, run = Test("checkpoint: sorted by id, contacts of spheres that exist"), file["run"].attrs
    ids = file["spheres/id"][()]
    test.expect((np.diff(ids) > 0).all() and ids[0] >= 0 and ids[-1] < run["next_id"], "ids of spheres")
    first, second = file["contacts/first_id"][()], file["contacts/second_id"][()]
    pairs = list(zip(first.tolist(), second.tolist()))
    test.expect(pairs == sorted(set(pairs)) and (first < second).all(), "order of contacts")
    test.expect(np.isin(first, ids).all() and np.isin(second, ids).all(), "ids of contacts")
    facets = [file["facet_contacts"][c][()].tolist() for c in ("id", "body", "feature")]
    keys = list(zip(*facets))
    test.expect(keys == sorted(set(keys)) and np.isin(facets[0], ids).all(), "order of facet contacts")
    for name in ("contacts", "facet_contacts"):
        test.expect((file[name]["contact_radius"][()] > 0).all(), f"/{name} holds some that do not touch")
    test.expect(len(pairs) > 0 and len(keys) > 0, "no contacts: this run shows nothing")
    test.print()


def check_geometry(file):
    """A pair in the list does overlap: ids, positions and radii belong together."""
    test = Test("checkpoint: contacts are where spheres meet")
    ids, place, radius = (file["spheres"][c][()] for c in ("id", "position", "radius"))
    i = np.searchsorted(ids, file["contacts/first_id"][()])
    j = np.searchsorted(ids, file["contacts/second_id"][()])
    gap = np.linalg.norm(place[i] - place[j], axis=1) - radius[i] - radius[j]
    # Forces are of the step before: a pair may have parted by the motion of one step.
    test.expect((gap < 1e-3 * radius.max()).all(), f"a gap of {gap.max()} m")
    test.print()


def check_checksums(file):
    test = Test("checkpoint: checksums are those of zlib")
    for name in TABLES:
        expect_checksums(test, file, name)
    for name in ("run/job", "monitors/names", "monitors/sums"):
        value = file[name][()]
        raw = value if isinstance(value, bytes) else value.tobytes()
        test.expect(file[name].attrs["checksum"] == zlib.crc32(raw), f"checksum of /{name}")
    test.expect(len(text(file["monitors/names"][()]).split()) == len(file["monitors/sums"]), "monitors")
    test.print()


def read_series(run, table):
    """The chain of segments: {column: values}, {column: unit}."""
    columns, units, n_checked = {}, {}, True
    for path in sorted(glob.glob(os.path.join(run, "series", "step_*.h5"))):
        with h5py.File(path, "r") as file:
            group = file[table]
            names = text(group.attrs["columns"]).split("\n")[:-1]
            n_checked = n_checked and set(names) == set(group)
            for name in names:
                data = group[name]
                n_checked = n_checked and data.shape == (group.attrs["n_rows"],)
                n_checked = n_checked and (len(data) == 0 or data.fletcher32)
                columns.setdefault(name, []).extend(data[()].tolist())
                units[name] = text(data.attrs["unit"])
    return columns, units, n_checked


def check_series(run, last, n_spheres, dt, every):
    test = Test("series: times, units, checksums")
    columns, units, well_formed = read_series(run, "series")
    test.expect(well_formed, "columns and rows of a segment do not agree, or have no checksum")
    times, steps = np.array(columns["time"]), np.array(columns["step"])
    expected = np.rint(np.arange(1, round(last * dt / every) + 1) * every / dt)
    test.expect(np.isin(expected, steps).all(), f"rows at steps {steps}")
    test.expect((np.diff(steps) > 0).all() and steps[-1] == last, "steps do not ascend to the end")
    test.expect((times == steps * dt).all(), "time is not step * dt")
    test.expect(units["time"] == "s" and units["kinetic_translation"] == "J", f"units {units}")
    test.expect(set(columns["n_spheres"]) == {float(n_spheres)}, "number of spheres")
    runtime, _, well_formed = read_series(run, "runtime")
    test.expect(well_formed and len(runtime["step"]) > 0, "runtime table")
    test.print()


def check_energy(run, file):
    """The last row and the checkpoint of the same step tell the same story."""
    test = Test("series: the last row agrees with the checkpoint")
    columns, _, _ = read_series(run, "series")
    total = file["spheres"]["dissipated_friction"][()].sum()
    test.expect(abs(total - columns["dissipated_friction"][-1]) <= 1e-9 * (1 + abs(total)),
                f"friction: {total}, {columns['dissipated_friction'][-1]}")
    test.expect(columns["n_contacts"][-1] == file["run"].attrs["n_contacts"], "number of contacts")
    test.print()


def main():
    run, n_spheres, dt, every = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4])
    paths = sorted(glob.glob(os.path.join(run, "checkpoints", "step_*.h5")))
    with h5py.File(paths[-1], "r") as file:
        check_counts(file, n_spheres, dt)
        check_order(file)
        check_geometry(file)
        check_checksums(file)
        check_series(run, file["run"].attrs["step"], n_spheres, dt, every)
        check_energy(run, file)


main()
