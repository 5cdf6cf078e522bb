"""The scenes as LIGGGHTS and LAMMPS read them: spheres as data, materials and walls as commands.

Both codes cut off no pull, so for the restitution that is asked for they take the damping ratio of a contact that
may pull; tremie, whose contacts do not, takes another one for the same restitution.  LAMMPS runs spheres of one
material with `gran/hertz/history`, 1.4 times as fast as `granular`, which the drum needs; its damping grows with
the width of a contact, not with the square root of that, and is that of the restitution for impacts at
IMPACT_SPEED.  It meets the drum as an exact cylinder, LIGGGHTS and tremie as triangles; so it has a filling of its
own, which tremie lets come to rest in such a cylinder.
"""
import csv
import math
import os
from dataclasses import dataclass, field

import h5py

from codes import WORK

CODES = ("liggghts", "lammps")


@dataclass
class Scene:
    packing: str  # where spheres are, below build/bench: a checkpoint or a packing of tremie
    box: tuple  # ((least, greatest), ...) that no sphere leaves [m]
    walls: dict  # commands by code, a function of the folder
    gravity: float = 9.81  # [m/s2]
    materials: tuple = ()
    pairs: dict = None  # (friction, restitution) by kinds of materials
    skins: tuple = ()  # to try [m]
    radius: float = 0.1  # mean, and where the packing has none [m]
    own_packing: dict = field(default_factory=dict)  # of a code that needs another one


@dataclass(frozen=True)
class Material:
    density: float  # [kg/m3]
    young: float  # [Pa]
    poisson: float


IMPACT_SPEED = 0.1  # [m/s]
ORE = Material(2367.0, 6.25e10, 0.2)
M1, M2, STEEL = Material(2500.0, 1e9, 0.2), Material(2000.0, 5e8, 0.2), Material(7200.0, 2.1e11, 0.2)


# ----------------------------------------------------------------------------------------------- spheres

def spheres(scene, packing):
    """Rows of type, radius, density, place, velocity, angular velocity."""
    file = os.path.join(WORK, packing)
    still = [0.0] * 3
    if file.endswith(".h5"):
        with h5py.File(file) as state:
            group = state["spheres"]
            places, n = group["position"][()].tolist(), len(group["position"])
            radii = group["radius"][()].tolist()
            motions = [group[key][()].tolist() if key in group else [still] * n for key in ("velocity", "angular_velocity")]
        return [(1, r, scene.materials[0].density, x, v, w) for r, x, v, w in zip(radii, places, *motions)]
    rows = []
    for row in csv.DictReader(open(file)):
        kind = 2 if row.get("material") == "dosta-m2" else 1
        place = [float(row[f"{axis}_m"]) for axis in "xyz"]
        rows.append((kind, float(row.get("radius_m", scene.radius)), scene.materials[kind - 1].density, place, still, still))
    return rows


def write_data(scene, packing, file):
    """Both codes read the same form."""
    rows = spheres(scene, packing)
    with open(file, "w") as out:
        out.write(f"a packing\n\n{len(rows)} atoms\n{len(scene.materials)} atom types\n\n")
        for axis, (least, most) in zip("xyz", scene.box):
            out.write(f"{least} {most} {axis}lo {axis}hi\n")
        out.write("\nAtoms\n\n")
        for k, (kind, radius, density, place, _, _) in enumerate(rows):
            out.write("%d %d %.17g %.17g %.17g %.17g %.17g\n" % (k + 1, kind, 2 * radius, density, *place))
        out.write("\nVelocities\n\n")
        for k, (*_, velocity, spin) in enumerate(rows):
            out.write("%d %.17g %.17g %.17g %.17g %.17g %.17g\n" % (k + 1, *velocity, *spin))


# ------------------------------------------------------------------------------------- materials and walls

def effective(a, b):
    """E*, G* [Pa]."""
    shear = [m.young / (2 * (1 + m.poisson)) for m in (a, b)]
    e_star = 1 / ((1 - a.poisson**2) / a.young + (1 - b.poisson**2) / b.young)
    return e_star, 1 / ((2 - a.poisson) / shear[0] + (2 - b.poisson) / shear[1])


def tsuji(restitution):
    """Damping over the root of mass times stiffness, as LAMMPS has it (Tsuji and others, 1992)."""
    return sum(c * restitution**k for k, c in enumerate((1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)))


def hertz_history(material, friction, restitution, radius):
    """Of equal spheres, whose impact at IMPACT_SPEED the damping is made for."""
    e_star, g_star = effective(material, material)
    mass, k_n = material.density * 2 / 3 * math.pi * radius**3, 4 / 3 * e_star
    overlap = (15 * mass * IMPACT_SPEED**2 / (16 * e_star * math.sqrt(radius / 2))) ** 0.4
    damping = tsuji(restitution) * math.sqrt(k_n / (mass * math.sqrt(radius / 2 * overlap)))
    return (f"{k_n:.10g} {8 * g_star:.10g} {damping:.10g} {math.sqrt(4 * g_star / e_star) * damping:.10g} {friction} 1")


def granular(a, b, friction, restitution):
    e_star, g_star = effective(a, b)
    damping = math.sqrt(4 * g_star / e_star)  # tangential over normal, as tremie has it
    return (f"hertz {4 / 3 * e_star:.10g} {restitution} tangential mindlin {8 * g_star:.10g} {damping:.10g} {friction} "
            "damping tsuji")


def scene_lammps(scene, folder):
    kinds = range(len(scene.materials))
    if len(kinds) == 1:
        lines = ["pair_style gran/" + law("lammps", scene), "pair_coeff * *"]
    else:
        lines = ["pair_style granular"] + [
            f"pair_coeff {i + 1} {j + 1} {granular(scene.materials[i], scene.materials[j], *scene.pairs[i, j])}"
            for i in kinds for j in kinds if i <= j]
    lines.append(f"fix fall all gravity {scene.gravity} vector 0 0 -1")
    return lines + scene.walls["lammps"](scene, folder)


def scene_liggghts(scene, folder):
    n = len(scene.materials)

    def matrix(k):
        return " ".join(str(scene.pairs[min(i, j), max(i, j)][k]) for i in range(n) for j in range(n))
    moduli = " ".join("%.10g" % m.young for m in scene.materials)
    lines = [f"fix young all property/global youngsModulus peratomtype {moduli}",
             "fix poisson all property/global poissonsRatio peratomtype " + " ".join(str(m.poisson) for m in scene.materials),
             f"fix restitution all property/global coefficientRestitution peratomtypepair {n} {matrix(1)}",
             f"fix friction all property/global coefficientFriction peratomtypepair {n} {matrix(0)}",
             "pair_style gran model hertz tangential history", "pair_coeff * *",
             f"fix fall all gravity {scene.gravity} vector 0 0 -1"]
    return lines + scene.walls["liggghts"](scene, folder)


def prepare(case):
    """Writes a scene's files; for each code where its commands and its spheres are."""
    scene, folder = case.peers, os.path.join(WORK, "peers", case.name)
    os.makedirs(folder, exist_ok=True)
    files = {}
    for code, lines in (("liggghts", scene_liggghts), ("lammps", scene_lammps)):
        files[code] = [os.path.join(folder, f"{code}.{end}") for end in ("scene", "data")]
        with open(files[code][0], "w") as out:
            out.write("\n".join(lines(scene, folder)) + "\n")
        write_data(scene, scene.own_packing.get(code, scene.packing), files[code][1])
    return files


def law(code, scene, kind=0):
    """What a wall, of the last material, does to spheres of a kind."""
    if code == "liggghts":
        return "model hertz tangential history"
    wall = len(scene.materials) - 1
    if wall == 0:
        return "hertz/history " + hertz_history(scene.materials[0], *scene.pairs[0, 0], scene.radius)
    return "granular " + granular(scene.materials[kind], scene.materials[wall], *scene.pairs[kind, wall])


def planes(code, scene, x=(None, None), y=(None, None), z=(None, None)):
    """Walls across the axes."""
    lines = []
    for axis, places in zip("xyz", (x, y, z)):
        if code == "lammps" and places != (None, None):
            between = " ".join("NULL" if place is None else str(place) for place in places)
            lines.append(f"fix wall_{axis} all wall/gran {law(code, scene)} {axis}plane {between}")
        elif code == "liggghts":
            lines += [f"fix wall_{axis}{k} all wall/gran {law(code, scene)} primitive type 1 {axis}plane {place}"
                      for k, place in enumerate(places) if place is not None]
    return lines


def quads_stl(file, quads):
    with open(file, "w") as out:
        out.write("solid wall\n")
        for a, b, c, d in quads:
            for corners in ((a, b, c), (a, c, d)):
                out.write("facet normal 0 0 0\nouter loop\n")
                out.writelines("vertex %.12g %.12g %.12g\n" % corner for corner in corners)
                out.write("endloop\nendfacet\n")
        out.write("endsolid wall\n")


def mesh(name, file, kind):
    """A surface for LIGGGHTS."""
    return [f"fix {name} all mesh/surface file {file} type {kind}",
            f"fix {name}_law all wall/gran model hertz tangential history mesh n_meshes 1 meshes {name}"]


def box_walls(x, y, z):
    return {code: lambda scene, folder, code=code: planes(code, scene, x, y, z) for code in CODES}


def gate_walls(x, y, z, speed):
    """The greater of x's walls moves."""
    def liggghts(scene, folder):
        low, high = -1, 20
        file = os.path.join(folder, "gate.stl")
        quads_stl(file, [((x[1], 2 * y[0], low), (x[1], 2 * y[1], low), (x[1], 2 * y[1], high), (x[1], 2 * y[0], high))])
        return planes("liggghts", scene, (x[0], None), y, z) + mesh("gate", file, 1) + [
            f"fix gate_moves all move/mesh mesh gate linear {-speed} 0 0"]

    def lammps(scene, folder):
        return planes("lammps", scene, (x[0], None), y, z) + [
            f"variable gate equal {-speed}*step*dt", f"region gate plane {x[1]} 0 0 -1 0 0 move v_gate NULL NULL",
            f"fix gate all wall/gran/region {law('lammps', scene)} region gate"]
    return {"liggghts": liggghts, "lammps": lammps}


def hole_walls(x, y, hole):
    """A floor at z = 0 from which the part between hole[0] and hole[1] is gone."""
    parts = ((x[0] - 1, hole[0]), (hole[1], x[1] + 1))

    def liggghts(scene, folder):
        file = os.path.join(folder, "floor.stl")
        quads_stl(file, [((a, 2 * y[0], 0), (b, 2 * y[0], 0), (b, 2 * y[1], 0), (a, 2 * y[1], 0)) for a, b in parts])
        return planes("liggghts", scene, x, y) + mesh("floor", file, 1)

    def lammps(scene, folder):
        lines = planes("lammps", scene, x, y)
        for k, (a, b) in enumerate(parts):
            lines += [f"region floor{k} block {a} {b} {2 * y[0]} {2 * y[1]} -1 0 side out",
                      f"fix floor{k} all wall/gran/region {law('lammps', scene)} region floor{k}"]
        return lines
    return {"liggghts": liggghts, "lammps": lammps}


def drum_walls(surface, radius, half, rate):
    """About -y: triangles, or a cylinder."""
    def liggghts(scene, folder):
        return mesh("drum", surface, 3) + [
            f"fix drum_turns all move/mesh mesh drum rotate origin 0 0 0 axis 0 -1 0 period {2 * math.pi / rate:.15g}"]

    def lammps(scene, folder):
        lines = [f"variable turned equal {rate}*step*dt",
                 f"region drum cylinder y 0 0 {radius} {-half} {half} side in rotate v_turned 0 0 0 0 -1 0"]
        for kind in (0, 1):
            lines += [f"group kind{kind} type {kind + 1}",
                      f"fix drum{kind} kind{kind} wall/gran/region {law('lammps', scene, kind)} region drum"]
        return lines
    return {"liggghts": liggghts, "lammps": lammps}
