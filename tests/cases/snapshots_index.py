#!/usr/bin/python3
"""Does the index of a run's snapshots describe those that are there, and nothing else?

    snapshots_index.py RUN [STEP...]     with STEPs: these are to be there, no others

Exit status 1, with the reason, when it does not.
"""
import glob
import os
import re
import sys
import xml.etree.ElementTree as tree


def wrong(why):
    print(why)
    sys.exit(1)


def main():
    folder = os.path.join(sys.argv[1], "snapshots")
    there = sorted(int(re.search(r"(\d+)\.h5", f).group(1)) for f in glob.glob(f"{folder}/step_*.h5"))
    if len(sys.argv) > 2 and there != [int(step) for step in sys.argv[2:]]:
        wrong(f"snapshots of steps {there}")
    times = None
    for name in ("spheres", "bodies"):
        domain = tree.parse(f"{folder}/{name}.xmf").getroot().find("Domain")
        for collection in domain.findall("Grid"):
            grids = collection.findall("Grid")
            times = [float(grid.find("Time").get("Value")) for grid in grids]
            if times != sorted(set(times)):
                wrong(f"{name}.xmf: times {times}")
            # A killed run may have published a file and not yet described it.
            if len(times) not in (len(there), len(there) - (len(sys.argv) == 2)):
                wrong(f"{name}.xmf: {len(times)} times for {len(there)} files")
            for item in collection.iter("DataItem"):
                if item.get("Format") == "HDF" and not os.path.exists(f"{folder}/{item.text.split(':')[0]}"):
                    wrong(f"{name}.xmf: {item.text} is not there")


main()
