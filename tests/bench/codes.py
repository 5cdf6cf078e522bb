"""How tremie and its peers are started, and what is read of a run that has ended."""
import glob
import math
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass, field

import h5py

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
WORK = os.path.abspath(os.environ.get("WORK") or os.path.join(ROOT, "build", "bench"))
OUT = os.path.abspath(os.environ.get("OUT") or HERE)
BIN = os.path.abspath(os.environ.get("BIN") or os.path.join(ROOT, "bin"))
CORE = os.environ.get("CORE") or "0"  # where runs of one rank are pinned
PHASES = ("bodies", "facets", "pairs", "integrate", "solids", "halo", "watch", "search", "redistribute", "repartition")


@dataclass
class Run:
    """What one run took and left."""
    n: int  # spheres
    steps: int
    wall: float  # of stepping alone [s]
    user: float  # CPU time of all ranks, starting up included [s]
    kinetic: float  # [J]
    contacts: int  # between spheres
    facet_contacts: object = ""
    searches: object = ""
    memory: object = ""  # of all ranks [bytes]
    phases: dict = field(default_factory=dict)  # of all ranks [s]
    checkpoint: object = None  # the last one's file
    checkpoint_wall: object = ""  # what writing it took [s]


def cores():
    """Of the machine; a second hardware thread of a core does not count."""
    pairs = {line for line in subprocess.run(["lscpu", "-p=CORE,SOCKET"], stdout=subprocess.PIPE, text=True).stdout.splitlines()
             if not line.startswith("#")}
    return max(1, min(len(pairs), os.cpu_count()))


def execute(name, command, ranks):
    """Runs it on the one core, or on so many ranks.  User CPU time [s] and the largest process's memory
    [bytes]; ends the program where it fails."""
    environment = dict(os.environ, RANKS=str(ranks), OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_btl_base_warn_component_unused="0")
    launch = ["taskset", "-c", CORE] if ranks == 1 else [os.path.join(ROOT, "config", "launch")]
    log = os.path.join(WORK, "runs", name + ".log")
    with open(log, "w") as out:
        process = subprocess.Popen(launch + command, cwd=os.path.dirname(log), env=environment, stdin=subprocess.DEVNULL,
                                   stdout=out, stderr=subprocess.STDOUT)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        print("failed:", " ".join(launch + command), file=sys.stderr)
        sys.exit("".join(open(log, errors="replace").readlines()[-20:]))
    return used.ru_utime, used.ru_maxrss * 1024


# ------------------------------------------------------------------------------------------------ tremie

def table(folder, name):
    """A table of a run's series: its columns, whole."""
    columns = {}
    for segment in sorted(glob.glob(os.path.join(folder, "series", "step_*.h5"))):
        with h5py.File(segment) as file:
            for column, data in file[name].items():
                columns.setdefault(column, []).extend(data[()].tolist())
    return columns


def tremie_run(name, job, options, step, steps, ledger, ranks, first=0, restart=None, isa="auto"):
    """A run of its own of `steps` steps of `step` seconds, those before `first` having been done by `restart`.
    Of the series, rows in which nothing moves tell of the start and of the last checkpoint."""
    folder = os.path.join(WORK, "runs", name)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(os.path.dirname(folder), exist_ok=True)
    settings = [("time.step", repr(step)), ("time.end", "%.12g" % ((first + steps) * step)),
                ("output.series.every", "%.12g" % (math.gcd(first, steps) * step)), ("contact.ledger", str(ledger).lower()),
                ("checkpoint.every.wall", 0), ("checkpoint.every.steps", 0), ("checkpoint.keep", 1), *options]
    command = [os.path.join(BIN, "tremie"), "run", os.path.join(HERE, job), "--out", folder, "--isa", isa]
    command += ["--restart", restart] if restart else []
    for key, value in settings:
        command += ["--set", f"{key}={value}"]
    user, peak = execute(name, command, ranks)
    series, runtime = table(folder, "series"), table(folder, "runtime")
    rows = [k for k, n in enumerate(runtime["particle_steps"]) if n > 0]

    def total(column):
        return sum(runtime[column][k] for k in rows)

    resident = max(runtime["memory.mean"]) * ranks
    return Run(n=int(runtime["n_spheres"][rows[-1]]), steps=int(total("steps")), wall=total("wall"), user=user,
               kinetic=series["kinetic_translation"][-1] + series["kinetic_rotation"][-1],
               contacts=int(series["n_contacts"][-1]), facet_contacts=int(series["n_facet_contacts"][-1]),
               searches=int(total("searches")), memory=peak if ranks == 1 else resident,
               phases={phase: total(f"{phase}.mean") * ranks for phase in PHASES},
               checkpoint=glob.glob(os.path.join(folder, "checkpoints", "*.h5"))[0],
               checkpoint_wall=sum(runtime["checkpoint.max"]))


def stored_by_walls(cell):
    """What walls of elements of this size store under an even pressure [J]."""
    folder = os.path.join(WORK, "runs", "walls")
    shutil.rmtree(folder, ignore_errors=True)
    execute("walls", [os.path.join(BIN, "tremie"), "run", os.path.join(HERE, "walls.yaml"), "--out", folder,
                      "--set", f"bodies.0.cell={cell}"], 1)
    return table(folder, "series")["elastic"][-1]


def data_bytes(checkpoint):
    """What a checkpoint's spheres and contacts take, each number as long as it is in the file: a sphere, a contact,
    all [bytes]."""
    with h5py.File(checkpoint) as file:
        def size(group):
            return sum(data.size * data.dtype.itemsize for data in file[group].values()) if group in file else 0

        def each(group, column):
            return size(group) / max(1, len(file[group][column])) if group in file else 0
        return each("spheres", "id"), each("contacts", "first_id"), sum(map(size, ("spheres", "contacts", "facet_contacts")))


def state_text(run):
    return (f"{run.n} spheres, kinetic energy {run.kinetic:.3g} J, {run.contacts} contacts, "
            f"z = {2 * run.contacts / run.n:.2f}, {run.facet_contacts} with bodies")


# ------------------------------------------------------------------------------------------------- peers

PROGRAMS = {"liggghts": os.environ.get("LIGGGHTS") or "liggghts", "lammps": os.environ.get("LAMMPS") or "lmp"}


def peer_is_here(code):
    return shutil.which(PROGRAMS[code]) is not None


def peer_run(code, name, scene, step, steps, start, skin, ranks, last="print done"):
    """A run of liggghts or lammps: `start` reads a state, `scene` is the file with materials and walls, `last` a
    command for its end."""
    command = [PROGRAMS[code], "-in", os.path.join(HERE, code + ".in"), "-log", "none"]
    for key, value in (("start", start), ("scene", scene), ("skin", skin), ("dt", step), ("steps", steps), ("last", last)):
        command += ["-var", key, str(value)]
    user, peak = execute(name, command, ranks)
    lines = [line.split() for line in open(os.path.join(WORK, "runs", name + ".log"), errors="replace")]
    loop = next(line for line in lines if line[:2] == ["Loop", "time"])
    translation, rotation, contacts = (float(x) for x in lines[lines.index(loop) - 1][1:4])
    searches = next((int(line[-1]) for line in lines if line[:3] == ["Neighbor", "list", "builds"]), "")
    return Run(n=int(loop[11]), steps=int(loop[8]), wall=float(loop[3]), user=user, kinetic=translation + rotation,
               contacts=int(contacts / 2), searches=searches, memory=peak if ranks == 1 else "")
