"""Reads the index of snapshots as ParaView does: times, numbers, radii, places.  For pvpython.

    snapshots_paraview.py PLAIN PACKED     two runs of snapshots.sh

What ParaView shows is compared with what the scene says.  Prints `ok NAME` or `FAIL NAME: why` lines.
"""
import sys

from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

TIMES = [0.005 * k for k in range(21)]


class Test:
    """One named result: the first thing that is wrong, if any."""

    def __init__(self, name):
        self.name, self.why = name, None

    def expect(self, condition, why):
        if not condition and self.why is None:
            self.why = why

    def print(self):
        print(f"ok {self.name}" if self.why is None else f"FAIL {self.name}: {self.why}", flush=True)


def fetch(reader, time):
    reader.UpdatePipeline(time)
    return servermanager.Fetch(reader)


def reader_of(test, run, name):
    reader = simple.XDMFReader(FileNames=[f"{run}/snapshots/{name}.xmf"])
    reader.UpdatePipelineInformation()
    times = list(reader.TimestepValues)
    near = len(times) == len(TIMES) and all(abs(a - b) < 1e-12 for a, b in zip(times, TIMES))
    test.expect(near, f"{name}: times {times}")
    return reader


def array_of(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def check_spheres(run, what, tolerance):
    test = Test(f"ParaView: {what} spheres, their numbers, radii, places, materials")
    reader = reader_of(test, run, "spheres")
    start, end = fetch(reader, 0.0), fetch(reader, 0.1)
    test.expect(start.GetNumberOfPoints() == 172 and end.GetNumberOfPoints() == 149, "number of spheres")
    test.expect(start.GetNumberOfCells() == 172, "points are not cells")
    data = fetch(reader, 0.0)  # back in time
    ids, radius = array_of(data, "id"), array_of(data, "radius")
    material, velocity = array_of(data, "material"), array_of(data, "velocity")
    test.expect(ids.tolist() == list(range(172)), f"ids {ids}")
    # The groups `above` and `beside` follow the 120 spheres of the file.
    test.expect(abs(radius[120:152] - 0.08).max() < tolerance, f"radii {radius[120:152]}")
    test.expect(abs(radius[152:] - 0.04).max() < tolerance, f"radii {radius[152:]}")
    test.expect(set(material[120:152]) == {1} and set(material[152:]) == {0}, "materials")
    # At step 0 the start's velocity and half a step of gravity and damping.
    test.expect(abs(velocity[120:152] - [0, 0.5, -3]).max() < 2e-3, f"velocities {velocity[120:152]}")
    place = vtk_to_numpy(data.GetPoints().GetData())
    test.expect(abs(place[120] - [-0.265, -0.265, 0.935]).max() < max(tolerance, 1e-9), f"the first is at {place[120]}")
    test.print()


def check_bodies(run):
    test = Test("ParaView: bodies at rest and moving")
    reader = reader_of(test, run, "bodies")
    for time in (0.0, 0.05, 0.1, 0.02):
        data = fetch(reader, time)
        test.expect(data.GetNumberOfBlocks() == 3, f"{data.GetNumberOfBlocks()} bodies")
        names = [data.GetMetaData(b).Get(data.NAME()) for b in range(3)]
        test.expect(names == ["trough", "paddle", "plate"], f"bodies {names} at {time} s")
        box = data.GetBlock(0)
        test.expect(box.GetNumberOfCells() == 8, f"{box.GetNumberOfCells()} triangles")
        test.expect(box.GetBounds() == (-0.5, 0.8, -0.5, 0.5, 0.0, 1.5), f"trough {box.GetBounds()}")
        lasted = min(max(time, 0.01), 0.07) - 0.01
        low = -0.45 + 0.2 * lasted
        test.expect(abs(data.GetBlock(2).GetBounds()[2] - low) < 1e-9, f"plate at {time} s")
    test.print()


def check_contacts(run):
    test = Test("ParaView: contacts, none at first")
    reader = reader_of(test, run, "contacts")
    test.expect(fetch(reader, 0.0).GetNumberOfCells() == 0, "contacts at the start")
    data = fetch(reader, 0.05)
    test.expect(data.GetNumberOfCells() == 9, f"{data.GetNumberOfCells()} contacts")
    test.expect(array_of(data, "force").shape == (9, 3), "forces")
    test.print()


def main():
    plain, packed = sys.argv[1:]
    check_spheres(plain, "plain", 1e-15)
    check_spheres(packed, "packed", 1e-7)
    check_bodies(plain)
    check_contacts(plain)


main()
