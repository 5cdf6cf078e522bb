#!/usr/bin/python3
"""Reads deformable bodies of snapshots with h5py alone, by what src/store/snapshot.h promises.

    solid_results_h5py.py HEAVY LIGHT ROLLING MIXED     four runs of solid_results.sh

Prints `ok NAME` or `FAIL NAME: why` lines.
"""
import glob
import os
import sys
import zlib

import h5py
import numpy as np

NODES = {
    "id": ("1", "<i8", 1),
    "position": ("m", "<f8", 3),
    "displacement": ("m", "<f8", 3),
    "velocity": ("m/s", "<f8", 3),
    "contact_force": ("N", "<f8", 3),
    "contact_pressure": ("Pa", "<f8", 1),
}
ELEMENTS = {
    "id": ("1", "<i8", 1),
    "stress": ("Pa", "<f8", 6),
    "von_mises": ("Pa", "<f8", 1),
    "principal_stress": ("Pa", "<f8", 3),
    "plastic_strain": ("1", "<f8", 1),
    "alive": ("1", "<i4", 1),
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


def series(run, column):
    parts = [h5py.File(path, "r")["series"] for path in sorted(glob.glob(f"{run}/series/*.h5"))]
    steps = np.concatenate([part["step"][()] for part in parts])
    return dict(zip(steps.astype(int), np.concatenate([part[column][()] for part in parts])))


def tensors(stress):
    return stress[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(-1, 3, 3)


def check_layout(run):
    test = Test("h5py: solids, their fields, units, checksums")
    for file in files(run):
        test.expect(text(file["run/solids"][()]) == "block\npulled\ndrawn\nsheared\nplate\n", "names")
        test.expect(file["run"].attrs["n_solids"] == 5 and len(file["bodies"]) == 0, "number of bodies")
        for name, solid in file["solids"].items():
            test.expect(text(solid.attrs["material"]) == "soft", f"material of {name}")
            for group, fields in (("nodes", NODES), ("elements", ELEMENTS)):
                n = len(solid["reference" if group == "nodes" else "corners"])
                test.expect(set(solid[group]) == set(fields), f"fields {sorted(solid[group])}")
                for field, (unit, kind, width) in fields.items():
                    data = solid[group][field]
                    test.expect(data.shape == ((n,) if width == 1 else (n, width)), f"{field} is {data}")
                    test.expect(data.dtype == np.dtype(kind) and text(data.attrs["unit"]) == unit, f"{field} is {data}")
                    sums = [zlib.crc32(data[i : i + 256].tobytes()) for i in range(0, n, 256)]
                    found = file[f"checksums/solids/{name}/{group}/{field}"][()].tolist()
                    test.expect(found == sums, f"checksums of {field}")
                test.expect((solid[group]["id"][()] == np.arange(n)).all(), f"ids of {group}")
    test.print()


def check_meshes(run):
    test = Test("h5py: meshes of solids, written once")
    first, *rest = files(run)
    for file in (first, *rest):
        for name, solid in file["solids"].items():
            for part in ("reference", "corners", "triangles"):
                test.expect(solid.attrs[f"{part}_step"] == 0, f"{part} of {name} is written again")
                where = os.path.basename(solid[part].file.filename)
                test.expect(where == "step_000000000000.h5", f"{part} of {name} is in {where}")
                raw = solid[part][()].tobytes()
                test.expect(solid[part].attrs["checksum"] == zlib.crc32(raw), f"checksum of {part}")
            way = solid["nodes/position"][()] - solid["reference"][()]
            test.expect((way == solid["nodes/displacement"][()]).all(), f"displacement of {name}")
    test.expect(first["solids/block/corners"].shape == (64, 8), "corners of hexahedra")
    test.expect(first["solids/drawn/corners"].shape == (192, 4), "corners of tetrahedra")
    x = first["solids/block/reference"][()]
    test.expect(x.min() == 0 and x.max() == 0.1, "places of the block")
    a, b, c = (x[first["solids/block/triangles"][:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    test.expect(abs(area - 0.06) < 1e-15, f"a surface of {area} m2")
    outwards = (np.cross(b - a, c - a) * ((a + b + c) / 3 - 0.05)).sum(axis=1)
    test.expect((outwards > 0).all(), "triangles that face inwards")
    test.print()


def check_stress(runs):
    test = Test("h5py: von Mises's and principal stresses are those of the tensors")
    for run in runs:
        for file in files(run):
            for solid in file["solids"].values():
                part = solid["elements"]
                full = tensors(part["stress"][()])
                scale = max(np.abs(full).max(), 1e-30)
                values = np.linalg.eigvalsh(full)[:, ::-1]
                test.expect(np.abs(values - part["principal_stress"][()]).max() < 1e-14 * scale, "principal stress")
                deviator = full - np.trace(full, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
                mises = np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2)))
                test.expect(np.abs(mises - part["von_mises"][()]).max() < 1e-14 * scale, "von Mises")
    shear = files(runs[1])[-1]["solids/sheared/elements"]
    test.expect(np.allclose(shear["principal_stress"][0], [0.4, 0, -0.4], atol=1e-6), "principal stresses of shear")
    pulled = files(runs[1])[-1]["solids/pulled/elements"]
    test.expect(np.allclose(pulled["principal_stress"][()], [1000, 0, 0], atol=0.01), "principal stresses of tension")
    test.print()


def check_contact(heavy, rolling):
    test = Test("h5py: contact forces and pressures add up to the body's force")
    solid = files(heavy)[-1]["solids/plate"]
    force, pressure = solid["nodes/contact_force"][()], solid["nodes/contact_pressure"][()]
    expected = series(heavy, "plate.force_z")[1400]
    test.expect(abs(force[:, 2].sum() - expected) < 1e-10 and expected < -0.3, f"{force[:, 2].sum()} N, not {expected}")
    # On a square grid an inner node of the top has the area of one cell, but for what it is bent.
    top = solid["reference"][:, 2] == 0.1
    total = (pressure * top).sum() * 0.02**2
    test.expect(abs(total + expected) < 2e-3 * abs(expected), f"pressure adds up to {total} N, not {-expected}")
    test.expect((pressure[~top] == 0).all(), "pressure where nothing touches")
    n_touched = 0
    for file in files(rolling)[1:]:
        step = int(file["run"].attrs["step"])
        force = file["solids/plate/nodes/contact_force"][()].sum(axis=0)
        for k, axis in enumerate("xyz"):
            expected = series(rolling, f"plate.force_{axis}")[step]
            test.expect(abs(force[k] - expected) < 1e-12 * max(1, abs(expected)), f"step {step}: {force[k]}, {expected}")
        n_touched += (np.abs(file["solids/plate/nodes/contact_force"][()]).max(axis=1) > 0).sum()
    test.expect(n_touched > 20, f"{n_touched} nodes are touched: this run shows nothing")
    test.print()


def check_probes(rolling):
    test = Test("h5py: probes are what snapshots show")
    for file in files(rolling):
        step, solid = int(file["run"].attrs["step"]), file["solids/plate"]
        node = np.linalg.norm(solid["reference"][()] - [0.2, 0.15, 0.04], axis=1).argmin()
        for field in ("displacement", "velocity"):
            for k, axis in enumerate("xyz"):
                found = series(rolling, f"middle.{field}_{axis}")[step]
                test.expect(found == solid[f"nodes/{field}"][node, k], f"{field} at step {step}")
        for field, pick in (("von_mises", np.max), ("plastic_strain", np.max)):
            found = series(rolling, f"whole.{field}_max")[step]
            test.expect(found == pick(solid[f"elements/{field}"][()]), f"{field} at step {step}")
        mean = solid["elements/stress"][:, 0].mean()  # elements have the same mass
        scale = np.abs(solid["elements/stress"][:, 0]).max() + 1e-30
        test.expect(abs(series(rolling, "whole.stress_xx")[step] - mean) < 1e-12 * scale, f"stress at step {step}")
    test.print()


def check_mixed(run):
    test = Test("h5py: both kinds of elements, chosen fields, single precision")
    solid = files(run)[-1]["solids/two"]
    test.expect(solid["corners"][()].tolist() == [[8, 9, 10, 11, -1, -1, -1, -1], list(range(8))], "corners")
    test.expect(solid["cells"][()].tolist() == [6, 8, 9, 10, 11, 9] + list(range(8)), "cells")
    test.expect(set(solid["nodes"]) == {"id", "position"}, f"fields {sorted(solid['nodes'])}")
    test.expect(set(solid["elements"]) == {"id", "stress", "plastic_strain"}, f"fields {sorted(solid['elements'])}")
    test.expect(solid["elements/stress"].dtype == np.dtype("<f4"), "precision")
    test.print()


def main():
    heavy, light, rolling, mixed = sys.argv[1:]
    check_layout(heavy)
    check_meshes(heavy)
    check_stress((heavy, light))
    check_contact(heavy, rolling)
    check_probes(rolling)
    check_mixed(mixed)


main()
