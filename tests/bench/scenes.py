"""What is measured: the cases, and the beds they start from.

A case runs a job with some options for some steps, from the job's own start or from a state that was left by
relaxing, which every code and every variant does for itself, without damping, so that contacts take up their
loads.  Beds are made once, into build/bench, by all cores: first soft and damped, in long steps, then stiffer in
stages, each of which takes over places and velocities alone.
"""
import math
import os
import random
import shutil
from dataclasses import dataclass, field

import h5py
import numpy

import codes
import peers

ROOT, WORK = codes.ROOT, codes.WORK
SEED = 1


@dataclass
class Case:
    """One scene to measure.  `options` are (key, value) pairs for tremie."""
    name: str
    what: str
    job: str
    step: float  # [s]
    steps: int  # that are measured
    prepare: object = None  # makes what the options name
    options: list = field(default_factory=list)
    relax: int = 0  # steps before, from which each variant goes on
    measured: list = field(default_factory=list)  # options of the measured steps alone
    rest_mass: float = 0.0  # of a sphere [kg], where they are to be at rest when it ends
    peers: object = None  # peers.Scene: how other codes run it; without: they do not
    peer_steps: int = 0  # measured beside peers, where not the same


# ------------------------------------------------------------------------------------------------ helpers

def path(*names):
    return os.path.join(WORK, *names)


def packing(file, kind=None):
    """Options by which spheres start from a file, of another kind than the job's where one is given."""
    kinds = [("spheres.0.packing.kind", kind)] if kind else []
    return kinds + [("spheres.0.packing.file", path(file))]


def made(file, make):
    """Has a file made, under another name until it is whole."""
    if not os.path.exists(path(file)):
        os.makedirs(os.path.dirname(path(file)), exist_ok=True)
        root, end = os.path.splitext(path(file))
        make(root + ".tmp" + end)
        os.rename(root + ".tmp" + end, path(file))


def settle(name, job, stages, result):
    """Runs stage after stage, each from where the one before has left the spheres; copies the last checkpoint.

    A stage is (options, step [s], steps).  The first one's options tell where spheres are at first."""
    checkpoint = None
    for number, (options, step, steps) in enumerate(stages):
        print(f"{name}: settling, stage {number + 1} of {len(stages)}, {steps} steps", flush=True)
        start = packing(checkpoint, "hdf5") if checkpoint else []
        run = codes.tremie_run(f"settle-{name}-{number}", job, start + options, step, steps, ledger=False, ranks=codes.cores())
        checkpoint = run.checkpoint
        print(f"{name}: {codes.state_text(run)}", flush=True)
    shutil.copyfile(checkpoint, result)


def stage(young, step, steps, damping, extra=()):
    """Of a bed of one material, with watches set wide."""
    return ([("materials.ore.young", young), ("damping", damping), ("watch.step", 3), ("watch.overlap", 0.5),
             ("watch.motion", 0.5), *extra], step, steps)


def loose(file, count, side, width, radii, shake, speed=0.0, base=0.0, centre=True):
    """A lattice, shaken so that what falls together is disordered: a packing, nowhere touching."""
    spacing, source = width / side, random.Random(SEED)
    equal = radii[0] == radii[1]
    shift = width / 2 if centre else 0.0
    with open(file, "w") as out:
        out.write("x_m,y_m,z_m" + ("" if equal else ",radius_m,vx_m_s,vy_m_s,vz_m_s") + "\n")
        for k in range(count):
            cell = (k % side, k // side % side, k // side**2)
            x, y, z = ((c + 0.5) * spacing + source.uniform(-shake, shake) for c in cell)
            out.write(f"{x - shift:.6f},{y - shift:.6f},{z + base:.6f}")
            if not equal:
                out.write(f",{source.uniform(*radii):.6f}" + "".join(f",{source.uniform(-speed, speed):.4f}" for _ in cell))
            out.write("\n")


# ------------------------------------------------------------------------------- 8768 spheres, 200 000, a million

def loose_8768(file, base=0.0):
    loose(file, 8768, 22, 5.3, (0.1, 0.1), 5.3 / 22 / 2 - 1.001 * 0.1, base=base)


def settled_8768():
    made("settled8768/loose.csv", loose_8768)
    made("settled8768/bed.h5", lambda file: settle("settled8768", "settled.yaml", [
        stage(6.25e10, 2.5e-5, 100000, 3, packing("settled8768/loose.csv"))], file))


def falling_8768():
    made("fall/high.csv", lambda file: loose_8768(file, base=3.0))


def dense(name, job, loose_file, options=()):
    """Makes a dense bed of 200 000 spheres: with little friction, and stiffening while it is damped; then, still
    damped, with its own friction."""
    little = [("contact.pairs.0.friction", 0.05), ("contact.pairs.0.restitution", 0.3), *options]
    first = packing(loose_file, "csv")
    return lambda file: settle(name, job, [
        stage(6.25e7, 3e-4, 7000, 3, little + first),
        stage(6.25e8, 1e-4, 4000, 30, little),
        stage(6.25e9, 3e-5, 4000, 60, little),
        stage(6.25e10, 1e-5, 8000, 100, little),
        stage(6.25e10, 1e-5, 4000, 100, options)], file)


def loose_200k(centre):
    width, side = 14.0, 63
    return lambda file: loose(file, 200000, side, width, (0.09, 0.11), width / side / 2 - 1.001 * 0.11, speed=2.0,
                              centre=centre)


def settled_200k():
    made("bed200k/loose.csv", loose_200k(True))
    made("bed200k/bed.h5", dense("bed200k", "bed.yaml", "bed200k/loose.csv"))


def flowing_200k(name, motion):
    """The bed after 10 000 steps of flow."""
    def make(file):
        settle(name, "bed.yaml", [(packing("bed200k/bed.h5") + motion, 1e-5, FLOW_STEPS)], file)
    settled_200k()
    made(f"{name}/flow.h5", make)


FLOW_STEPS = 10000
FLOW_TIME = FLOW_STEPS * 1e-5  # [s]
GATE_SPEED = 1.0  # [m/s]
GATE_AT = 7.0 - GATE_SPEED * FLOW_TIME / 2  # where the gate is when measuring begins [m]


def ramp(pieces=20):
    """The gate comes to its speed evenly, so that no shock runs through the bed."""
    times = [FLOW_TIME * k / pieces for k in range(pieces + 1)]
    points = ", ".join(f"{{time: {t:.6g}, place: [{-GATE_SPEED * t**2 / (2 * FLOW_TIME):.9g}, 0, 0]}}" for t in times)
    return [("bodies.0.motion", f"{{path: {{points: [{points}]}}}}")]


GATE_MEASURED = [("bodies.0.motion", f"{{velocity: [{-GATE_SPEED}, 0, 0]}}"),
                 ("bodies.0.geometry.move", f"[{GATE_AT - 7.0:.9g}, 0, 0]")]
OPEN = [("bodies.1.active", "[1e8, 1e9]")]  # the plug is not there


def million():
    """Five beds, repeated each in its own width, side by side: they join without a seam."""
    def tile(file):
        with h5py.File(path("million/tile.h5")) as one, h5py.File(file, "w") as out:
            places, radius = one["spheres/position"][()], one["spheres/radius"][()]
            places = numpy.mod(places, [14.0, 14.0, math.inf])
            copies = [places + [14.0 * k, 0, 0] for k in range(5)]
            out["spheres/position"] = numpy.concatenate(copies)
            out["spheres/radius"] = numpy.tile(radius, 5)
    made("million/loose.csv", loose_200k(False))
    made("million/tile.h5", dense("million", "million.yaml", "million/loose.csv", [("domain.max", "[14, 14, 20]")]))
    made("million/bed.h5", tile)


# ------------------------------------------------------------------------------------------------- the drum

DRUM_RADIUS, DRUM_HALF, DRUM_SEGMENTS, DRUM_ROWS = 0.1, 0.03, 100, 3  # [m], [m]


def drum_surface(file):
    """A cylinder about y of 600 triangles and its ends, of 300 each."""
    def point(radius, k, y):
        angle = 2 * math.pi * k / DRUM_SEGMENTS
        return radius * math.cos(angle), y, radius * math.sin(angle)
    triangles = []
    for k in range(DRUM_SEGMENTS):
        for row in range(DRUM_ROWS):
            low, high = (-DRUM_HALF + 2 * DRUM_HALF * r / DRUM_ROWS for r in (row, row + 1))
            a, b = point(DRUM_RADIUS, k, low), point(DRUM_RADIUS, k + 1, low)
            c, d = point(DRUM_RADIUS, k + 1, high), point(DRUM_RADIUS, k, high)
            triangles += [(a, b, c), (a, c, d)]
        for y in (-DRUM_HALF, DRUM_HALF):
            a, b = point(DRUM_RADIUS / 2, k, y), point(DRUM_RADIUS / 2, k + 1, y)
            c, d = point(DRUM_RADIUS, k + 1, y), point(DRUM_RADIUS, k, y)
            triangles += [(point(0, k, y), a, b), (a, b, c), (a, c, d)]
    with open(file, "w") as out:
        out.write("solid drum\n")
        for corners in triangles:
            out.write("facet normal 0 0 0\nouter loop\n")
            out.writelines("vertex %.12g %.12g %.12g\n" % corner for corner in corners)
            out.write("endloop\nendfacet\n")
        out.write("endsolid drum\n")


def drum_packing(checkpoint, file):
    """A packing with radius and material, which a checkpoint's is not."""
    with h5py.File(checkpoint) as state, open(file, "w") as out:
        out.write("x_m,y_m,z_m,radius_m,material\n")
        for place, radius in zip(state["spheres/position"][()].tolist(), state["spheres/radius"][()].tolist()):
            kind = "dosta-m2" if radius > 0.0015 else "dosta-m1"
            out.write("%.17g,%.17g,%.17g,%.17g,%s\n" % (*place, radius, kind))


# A folder with the paper's own drum.stl and drum_spheres.csv, in place of what is made here.
GIVEN = os.environ.get("DRUM")
DRUM = "drum_given" if GIVEN else "drum"


def given_packing(file):
    """The paper's filling, its materials named as in config/materials.yaml."""
    with open(os.path.join(GIVEN, "drum_spheres.csv")) as spheres, open(file, "w") as out:
        for line in spheres:
            out.write(line.replace(",M1", ",dosta-m1").replace(",M2", ",dosta-m2"))


def drum_stage(name, start, moduli, step, steps, damping, geometry):
    """Goes on in a drum that does not turn, damped; the checkpoint that it ends with."""
    still = [("bodies.0.motion.start", 1), ("watch.step", 3), ("watch.overlap", 0.5), ("watch.motion", 0.5)]
    run = codes.tremie_run(f"settle-{name}", "drum.yaml", packing(start) + moduli + still
                           + [("damping", damping), ("bodies.0.geometry", geometry)], step, steps, ledger=False, ranks=codes.cores())
    print(f"{name}: {codes.state_text(run)}", flush=True)
    return run.checkpoint


def own_packing(file):
    surface = "{kind: stl, file: %s}" % path("drum/drum.stl")
    run = codes.tremie_run("settle-drum", os.path.join(ROOT, "jobs", "drum_soft.yaml"), [("bodies.0.geometry", surface)], 5e-5, 5000,
                           ledger=False, ranks=codes.cores())
    print(f"drum: {codes.state_text(run)}", flush=True)
    left = run.checkpoint
    for number, (young, step, damping) in enumerate(((2e7, 1e-5, 300), (2e8, 3e-6, 1000), (1e9, 8e-7, 3000))):
        drum_packing(left, path("drum/stage.csv"))
        moduli = [("materials.dosta-m1.young", young), ("materials.dosta-m2.young", young / 2)]
        left = drum_stage(f"drum-{number}", "drum/stage.csv", moduli, step, 4000, damping, surface)
    drum_packing(left, file)


def round_packing(file):
    """The filling at rest in the cylinder that the facets' corners lie on, for a code that has no triangles."""
    cylinder = (f"{{kind: cylinder, from: [0, {-DRUM_HALF}, 0], to: [0, {DRUM_HALF}, 0], radius: {DRUM_RADIUS}, "
                "caps: [from, to], segments: exact}")
    drum_packing(drum_stage("drum-round", f"{DRUM}/packing.csv", [], 8e-7, 15000, 1000, cylinder), file)


def drum():
    made(f"{DRUM}/drum.stl", (lambda file: shutil.copyfile(os.path.join(GIVEN, "drum.stl"), file)) if GIVEN else drum_surface)
    made(f"{DRUM}/packing.csv", given_packing if GIVEN else own_packing)
    made(f"{DRUM}/round.csv", round_packing)


# ------------------------------------------------------------------------------------------------ mixtures

SIZES = {
    "equal": ("one radius", "{kind: list, radii: [{radius: 0.01, share: 1}]}"),
    "two": ("radii 1 and 20", "{kind: list, by: mass, radii: [{radius: 0.01, share: 3}, {radius: 0.2, share: 8}]}"),
    "spread": ("radii from 1 to 20", None),  # as in mixture.yaml
}


def mixtures():
    """Each bed falls from a random packing, damped; lists are made when due, and often, as in fast flow."""
    cases = []
    for name, (what, sizes) in SIZES.items():
        options = [("spheres.0.sizes", sizes)] if sizes else []
        for end, often, more in (("", 0, ""), ("_searched", 20, ", a search every 20 steps")):
            cases.append(Case(f"mixture_{name}{end}", f"6000 settled spheres, {what}{more}", "mixture.yaml", 2e-5, 4000,
                              options=options, relax=40000, measured=[("testing.search_every", often)]))
    return cases


# ------------------------------------------------------------------------------------------------- the list

def ore_scene(packing_file, x, y, z, walls, skins):
    return peers.Scene(packing_file, (x, y, z), walls, materials=(peers.ORE,), pairs={(0, 0): (0.5, 0.5)}, skins=skins)


MASS = 2367 * 4 / 3 * math.pi * 0.1**3  # of a sphere of ore [kg]
STILL, MOVING = (0.0025, 0.005, 0.01), (0.005, 0.01, 0.02, 0.04)  # skins to try [m]
NARROW, WIDE = (-2.65, 2.65), (-7.0, 7.0)
BOX_8768 = peers.box_walls(NARROW, NARROW, (0, None))

CASES = [
    Case("hopper", "jobs/hopper.yaml, whole: 8768 spheres fall through a hopper into a bin",
         os.path.join(ROOT, "jobs", "hopper.yaml"), 1e-5, 150000),
    Case("settled8768", "the same spheres at rest in a box", "settled.yaml", 1e-5, 6000, settled_8768,
         packing("settled8768/bed.h5", "hdf5"), relax=2000, rest_mass=MASS,
         peers=ore_scene("settled8768/bed.h5", (-2.7, 2.7), (-2.7, 2.7), (-0.05, 5), BOX_8768, STILL)),
    Case("settled200k", "200 000 spheres, radii within 10 %, at rest in a box", "bed.yaml", 1e-5, 1000, settled_200k,
         packing("bed200k/bed.h5"), relax=2000, rest_mass=MASS,
         peers=ore_scene("bed200k/bed.h5", (-7.1, 7.1), (-7.1, 7.1), (-0.1, 20),
                         peers.box_walls(WIDE, WIDE, (0, None)), STILL)),
    Case("gate200k", "that bed while a side wall moves in at 1 m/s", "bed.yaml", 1e-5, 1000,
         lambda: flowing_200k("gate200k", ramp()), packing("gate200k/flow.h5") + GATE_MEASURED,
         peers=ore_scene("gate200k/flow.h5", (-7.1, 7.1), (-7.1, 7.1), (-0.1, 20),
                         peers.gate_walls((-7.0, GATE_AT), WIDE, (0, None), GATE_SPEED), MOVING)),
    Case("hole200k", "that bed while it runs out through half of the floor", "bed.yaml", 1e-5, 1000,
         lambda: flowing_200k("hole200k", OPEN), packing("hole200k/flow.h5") + OPEN,
         peers=ore_scene("hole200k/flow.h5", (-7.1, 7.1), (-7.1, 7.1), (-10, 20),
                         peers.hole_walls(WIDE, WIDE, (-3.5, 3.5)), MOVING)),
    Case("drum", "38 000 spheres of two kinds in a turning drum of 1200 triangles", "drum.yaml", 8e-7, 20000,
         drum,
         packing(f"{DRUM}/packing.csv") + [("bodies.0.geometry.file", path(DRUM, "drum.stl"))], peer_steps=4000,
         peers=peers.Scene(f"{DRUM}/packing.csv", own_packing={"lammps": f"{DRUM}/round.csv"}, box=((-0.11, 0.11), (-0.035, 0.035), (-0.11, 0.11)),
                           walls=peers.drum_walls(path(DRUM, "drum.stl"), DRUM_RADIUS, DRUM_HALF, 2.0), gravity=9.8,
                           materials=(peers.M1, peers.M2, peers.STEEL), skins=(2.5e-5, 5e-5, 1e-4, 2e-4),
                           pairs={(0, 0): (0.3, 0.5), (0, 1): (0.2, 0.45), (0, 2): (0.2, 0.4), (1, 1): (0.4, 0.4),
                                  (1, 2): (0.2, 0.4), (2, 2): (0.5, 0.6)})),
    *mixtures(),
    Case("million", "a million spheres at rest, repeated along x and y", "million.yaml", 1e-5, 200, million,
         packing("million/bed.h5"), relax=2000, rest_mass=MASS),
    Case("fall", "8768 spheres that fall and meet nothing", "settled.yaml", 1e-5, 12000, falling_8768,
         packing("fall/high.csv"),
         peers=ore_scene("fall/high.csv", (-2.7, 2.7), (-2.7, 2.7), (-0.05, 9), BOX_8768, MOVING)),
]

# The first example with walls that do not deform, then with walls that do, of elements as large as this.
WALL_CELLS = {2.1: "48", 1.3: "120", 1.1: "168", 0.8: "320"}
FINE_CELL = 0.35  # 1496 elements
WALLS = [
    Case("rigid", "", os.path.join(ROOT, "jobs", "hopper.yaml"), 1e-5, 150000, options=[("output.snapshots.every", 0.1)]),
    *(Case(f"shell, `cell: {cell}`", elements, os.path.join(ROOT, "jobs", "hopper_deformable.yaml"), 1e-5, 150000,
           options=[("bodies.0.cell", cell)]) for cell, elements in WALL_CELLS.items()),
]
