"""Reads the index of shells and membranes as ParaView does: quads, triangles, where they are.  For pvpython.

    sheets_paraview.py RUN     a run of sheets.sh

Prints `ok NAME` or `FAIL NAME: why`.
"""
import sys

from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

TRIANGLE, QUAD = 5, 9

reader = simple.XDMFReader(FileNames=[f"{sys.argv[1]}/snapshots/solids.xmf"])
reader.UpdatePipelineInformation()
reader.UpdatePipeline(0.02)
data = servermanager.Fetch(reader)
seen = []
for b, (name, kind, cells, nodes) in enumerate((("bin", QUAD, 300, 321), ("cloth", TRIANGLE, 324, 181), ("blade", QUAD, 30, 42))):
    grid = data.GetBlock(b)
    found = (data.GetMetaData(b).Get(data.NAME()), grid.GetCellType(0), grid.GetNumberOfCells(), grid.GetNumberOfPoints())
    if found != (name, kind, cells, nodes):
        seen.append(f"body {b} is {found}")
    moved = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    if not abs(moved).max() > 1e-3:
        seen.append(f"{name} has not moved")
    stress = vtk_to_numpy(grid.GetCellData().GetArray("von_mises"))
    if stress.shape != (cells,) or not stress.max() > 0:
        seen.append(f"{name} is without stress")
print(f"FAIL ParaView: {seen[0]}" if seen else "ok ParaView: shells and membranes, their cells, places, stresses")
