"""Reads the index of deformable bodies as ParaView does: cells, fields, places.  For pvpython.

    solid_results_paraview.py HEAVY MIXED     two runs of solid_results.sh

Prints `ok NAME` or `FAIL NAME: why` lines.
"""
import sys

from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

TETRAHEDRON, HEXAHEDRON = 10, 12


class Test:
    """One named result: the first thing that is wrong, if any."""

    def __init__(self, name):
        self.name, self.why = name, None

    def expect(self, condition, why):
        if not condition and self.why is None:
            self.why = why

    def print(self):
        print(f"ok {self.name}" if self.why is None else f"FAIL {self.name}: {self.why}", flush=True)


def reader_of(run):
    reader = simple.XDMFReader(FileNames=[f"{run}/snapshots/solids.xmf"])
    reader.UpdatePipelineInformation()
    return reader


def fetch(reader, time):
    reader.UpdatePipeline(time)
    return servermanager.Fetch(reader)


def check_solids(run):
    test = Test("ParaView: solids, their cells, stresses, places")
    reader = reader_of(run)
    times = list(reader.TimestepValues)
    test.expect(len(times) == 5 and abs(times[4] - 0.14) < 1e-12, f"times {times}")
    start, data = fetch(reader, 0.0), fetch(reader, 0.14)
    names = [data.GetMetaData(b).Get(data.NAME()) for b in range(data.GetNumberOfBlocks())]
    test.expect(names == ["block", "pulled", "drawn", "sheared", "plate"], f"solids {names}")
    for b, (kind, cells, nodes) in enumerate(((HEXAHEDRON, 64, 125), (HEXAHEDRON, 32, 81), (TETRAHEDRON, 192, 81))):
        grid = data.GetBlock(b)
        found = (grid.GetCellType(0), grid.GetNumberOfCells(), grid.GetNumberOfPoints())
        test.expect(found == (kind, cells, nodes), f"{names[b]} is {found}")
    block = data.GetBlock(0).GetCellData()
    stress = vtk_to_numpy(block.GetArray("stress"))
    test.expect(stress.shape == (64, 6), f"stress {stress.shape}")
    test.expect(abs(stress[:16, 2].mean() + 1716.75) < 2, f"stress at the foot {stress[:16, 2].mean()}")
    test.expect(vtk_to_numpy(block.GetArray("principal_stress")).shape == (64, 3), "principal stress")
    test.expect(set(vtk_to_numpy(block.GetArray("alive"))) == {1}, "alive")
    points = data.GetBlock(4).GetPointData()
    test.expect(vtk_to_numpy(points.GetArray("contact_pressure")).max() > 100, "contact pressure")
    sunk = start.GetBlock(0).GetBounds()[5] - data.GetBlock(0).GetBounds()[5]
    test.expect(abs(sunk - 9.2e-5) < 1e-5, f"the block sinks by {sunk} m")
    test.print()


def check_mixed(run):
    test = Test("ParaView: both kinds of elements")
    grid = fetch(reader_of(run), 1e-3)  # a single one
    test.expect([grid.GetCellType(c) for c in range(2)] == [TETRAHEDRON, HEXAHEDRON], "kinds of cells")
    test.expect(grid.GetNumberOfPoints() == 12, "nodes")
    test.expect(vtk_to_numpy(grid.GetCellData().GetArray("stress")).shape == (2, 6), "stress")
    test.print()


def main():
    heavy, mixed = sys.argv[1:]
    check_solids(heavy)
    check_mixed(mixed)


main()
