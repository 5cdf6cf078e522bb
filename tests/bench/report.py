"""Rows, medians and tables of what was measured."""
import csv
import os
import platform
import re
import statistics
import subprocess

import codes

# Spheres at rest move less than this on average (root mean square; a bed without rolling resistance never quite
# stops) [m/s].
SPEED_AT_REST = 0.03
# Codes are in the same state whose numbers of contacts and kinetic energies differ by no more, relatively.
APART = 0.03
WITH, WITHOUT = "tremie", "tremie without ledger"
SHOWN = ("pairs", "facets", "integrate", "search")  # phases that tables show; the others are added up
CHECKPOINT_EVERY = 300  # [s] of wall clock, that the cost of a checkpoint is compared with

SUITE = ("case", "code", "ranks", "rounds", "spheres", "steps", "rate", "least", "most", "rate_by_user", "efficiency", "z",
         "contacts_a_sphere", "ns_a_contact", *(f"{phase}_ns" for phase in codes.PHASES), "steps_between_searches",
         "bytes_a_sphere", "kinetic_J", "checkpoint_s", "checkpoint_bytes", "data_bytes", "sphere_bytes", "contact_bytes",
         "isa", "machine")
RATE, RATIO, RATIO_WITHOUT = ("million particle-steps/s", "ratio tremie to this code",
                              "ratio tremie without ledger to this code")
PEERS = ("case", "code", "ranks", RATE, RATIO, "ratio_least", "ratio_most", RATIO_WITHOUT, "ratio_without_least",
         "ratio_without_most", "ratio_by_wall", "ratio_without_by_wall", "rate_least", "rate_most", "rate_by_wall", "rounds",
         "steps", "skin_m", "steps_between_searches", "bytes_a_sphere", "kinetic_J", "contacts", "isa", "machine")


def machine():
    lines = subprocess.run(["lscpu"], stdout=subprocess.PIPE, text=True).stdout.splitlines()
    facts = dict(line.split(":", 1) for line in lines if ":" in line)
    name, flags = facts.get("Model name", platform.machine()).strip(), facts.get("Flags", "").split()
    width = "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else "neither AVX2 nor AVX-512"
    return f"{name}; {width}; {codes.cores()} cores"


def row(case, variant, number, run):
    """What is kept of one run."""
    user = run.user - variant.start
    work = run.n * run.steps
    touching = run.contacts + (run.facet_contacts or 0)
    kept = {"case": case.name, "code": variant.code, "isa": variant.isa, "ranks": variant.ranks, "round": number, "spheres": run.n,
            "steps": run.steps, "wall_s": run.wall, "user_s": user, "rate_wall": work / run.wall * 1e-6,
            "rate_user": work / user * 1e-6 if user > 0 else float("nan"), "z": 2 * run.contacts / run.n,
            "contacts": run.contacts, "contacts_a_sphere": touching / run.n,
            "ns_a_contact": 1e9 * user / run.steps / touching if touching else "",
            "steps_between_searches": run.steps / run.searches if run.searches else "",
            "bytes_a_sphere": run.memory / run.n if run.memory else "", "kinetic_J": run.kinetic,
            "skin_m": getattr(variant, "skin", ""), "rest_mass": case.rest_mass,
            "own_packing": bool(case.peers) and variant.code in case.peers.own_packing}
    kept |= {f"{phase}_ns": 1e9 * time / work for phase, time in run.phases.items()}
    if run.checkpoint:
        sphere, contact, data = codes.data_bytes(run.checkpoint)
        kept |= {"checkpoint_s": run.checkpoint_wall, "checkpoint_bytes": os.path.getsize(run.checkpoint),
                 "data_bytes": data, "sphere_bytes": sphere, "contact_bytes": contact}
    return kept


def median(rows, column):
    values = [r[column] for r in rows if r.get(column, "") != ""]
    return statistics.median(values) if values else ""


def spread(values, digits=2):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def by_isa(rows):
    """What was measured with each of tremie's instruction sets, and of its peers, which have none."""
    return {isa: [r for r in rows if r["isa"] in (isa, "")] for isa in dict.fromkeys(r["isa"] for r in rows) if isa}


def groups(rows):
    """Rows of each case, code and number of ranks, in order."""
    found = {}
    for r in rows:
        found.setdefault((r["case"], r["code"], r["ranks"]), []).append(r)
    return found


# ------------------------------------------------------------------------------------------------- files

def write(file, columns, rows):
    os.makedirs(os.path.dirname(file), exist_ok=True)
    with open(file, "w", newline="") as out:
        writer = csv.DictWriter(out, columns, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        for r in rows:
            writer.writerow({key: f"{value:.6g}" if isinstance(value, float) else value for key, value in r.items()})


def read(name):
    file = os.path.join(codes.OUT, name + ".csv")
    return list(csv.DictReader(open(file))) if os.path.exists(file) else []


def merge(name, columns, rows):
    """Rows take the place of those of the same cases and kernel in NAME.csv; the others stay."""
    new = {(r["case"], r["isa"]) for r in rows}
    write(os.path.join(codes.OUT, name + ".csv"), columns, [r for r in read(name) if (r["case"], r["isa"]) not in new] + rows)


def name_of(r):
    """What a table calls a row's case."""
    return r["case"] + (f", {r['isa']}" if r["isa"] != "auto" else "")


def keep_rounds(name, rows):
    """Every run, for those who want to look closer."""
    columns = list(dict.fromkeys(key for r in rows for key in r))
    write(os.path.join(codes.WORK, name + "_rounds.csv"), columns, rows)


# ------------------------------------------------------------------------------------------------- the suite

def keep_suite(rows):
    keep_rounds("suite", rows)
    merge("suite", SUITE, [r for isa, own in by_isa(rows).items() for r in suite_of(isa, own)])


def suite_of(isa, rows):
    result, by_key = [], groups(rows)
    for (case, code, ranks), own in by_key.items():
        rates = [r["rate_wall"] for r in own]
        one = {r["round"]: r["rate_wall"] for r in by_key.get((case, code, 1), [])}
        efficiency = [r["rate_wall"] / one[r["round"]] / ranks for r in own if r["round"] in one]
        result.append({key: median(own, key) for key in SUITE if key in own[0] and key not in ("case", "code", "isa")}
                      | {"case": case, "code": code, "ranks": ranks, "rounds": len(own), "rate": statistics.median(rates),
                         "least": min(rates), "most": max(rates), "rate_by_user": median(own, "rate_user"),
                         "efficiency": statistics.median(efficiency) if efficiency else "", "isa": isa, "machine": machine()})
    return result


def number(text, digits=2):
    return f"{float(text):.{digits}f}" if text != "" else ""


def suite_table():
    lines = ["| case | spheres | z | ranks | million particle-steps/s | efficiency | " + " | ".join(SHOWN)
             + " | others | steps between searches | bytes a sphere |", "|" + " --- |" * (9 + len(SHOWN))]
    for r in read("suite"):
        phases = {phase: float(r.get(f"{phase}_ns") or 0) for phase in codes.PHASES}
        others = sum(time for phase, time in phases.items() if phase not in SHOWN)
        name = name_of(r) + (", without ledger" if r["code"] == WITHOUT else "")
        rate = f"{number(r['rate'])} ({number(r['least'])} to {number(r['most'])})"
        lines.append(f"| {name} | {float(r['spheres']):.0f} | {number(r['z'])} | {r['ranks']} | {rate} | {number(r['efficiency'])} | "
                     + " | ".join(f"{phases[phase]:.1f}" for phase in SHOWN)
                     + f" | {others:.1f} | {number(r['steps_between_searches'], 0)} | {number(r['bytes_a_sphere'], 0)} |")
    return lines


def checkpoint_table():
    lines = [f"| case | ranks | one checkpoint [s] | of {CHECKPOINT_EVERY} s [%] | file [MB] | data [MB] | file over data | "
             "bytes a sphere | bytes a contact |", "|" + " --- |" * 9]
    for r in read("suite"):
        if float(r["spheres"]) < 1e5:
            continue
        took, size, data = (float(r[key]) for key in ("checkpoint_s", "checkpoint_bytes", "data_bytes"))
        name = name_of(r) + (", without ledger" if r["code"] == WITHOUT else "")
        lines.append(f"| {name} | {r['ranks']} | {took:.2f} | {100 * took / CHECKPOINT_EVERY:.2f} | {size * 1e-6:.1f} | "
                     f"{data * 1e-6:.1f} | {size / data:.3f} | {number(r['sphere_bytes'], 0)} | {number(r['contact_bytes'], 0)} |")
    return lines


def contact_table():
    lines = ["| bed | contacts a sphere | ns a contact and step | of one radius | a search every 20 steps | of one radius |",
             "|" + " --- |" * 6]
    rows = {r["case"]: r for r in read("suite") if r["ranks"] == "1" and r["code"] == WITH and r["isa"] == "auto"}
    for name in ("equal", "two", "spread"):
        own = [rows.get(f"mixture_{name}{end}") for end in ("", "_searched")]
        base = [rows.get(f"mixture_equal{end}") for end in ("", "_searched")]
        if None in own + base:
            continue
        cost = [float(r["ns_a_contact"]) for r in own]
        over = [c / float(r["ns_a_contact"]) for c, r in zip(cost, base)]
        lines.append(f"| {name} | {number(own[0]['contacts_a_sphere'])} | {cost[0]:.1f} | {over[0]:.2f} | {cost[1]:.1f} | {over[1]:.2f} |")
    return lines


def suite(rows):
    """Prints what is in suite.csv; fails where a bed is not at rest that ought to be."""
    print("\n" + "\n".join(suite_table()))
    print("\n" + "\n".join(checkpoint_table()))
    print("\n" + "\n".join(contact_table()))
    return 0 if all(case_is_at_rest(own) for own in groups(rows).values()) else 1


def case_is_at_rest(own):
    """Where it ought to be."""
    last = own[-1]
    if not last["rest_mass"]:
        return True
    speed = (2 * last["kinetic_J"] / last["spheres"] / last["rest_mass"]) ** 0.5
    if speed > SPEED_AT_REST:
        print(f"{last['case']}: NOT at rest, {speed:.3g} m/s (root mean square)")
    return speed <= SPEED_AT_REST


# ------------------------------------------------------------------------------------------------- peers

def ratios(by_key, case, code, ranks, of, column):
    """Of tremie's rates to this code's, round by round."""
    own = {r["round"]: r[column] for r in by_key.get((case, code, ranks), [])}
    return [r[column] / own[r["round"]] for r in by_key.get((case, of, ranks), []) if r["round"] in own]


def keep_peers(rows):
    keep_rounds("peers", rows)
    merge("peers", PEERS, [r for isa, own in by_isa(rows).items() for r in peers_of(isa, own)])


def peers_of(isa, rows):
    by_key, result = groups(rows), []
    for (case, code, ranks), own in by_key.items():
        main = "rate_user" if ranks == 1 else "rate_wall"
        rates, walls = [r[main] for r in own], [r["rate_wall"] for r in own]
        kept = {key: median(own, key) for key in PEERS if key in own[0] and key not in ("case", "code", "isa")}
        kept |= {"case": case, "code": code, "ranks": ranks, RATE: statistics.median(rates), "rate_least": min(rates),
                 "rate_most": max(rates), "rate_by_wall": statistics.median(walls), "rounds": len(own), "isa": isa,
                 "machine": machine()}
        for of, names in ((WITH, (RATIO, "ratio_least", "ratio_most", "ratio_by_wall")),
                          (WITHOUT, (RATIO_WITHOUT, "ratio_without_least", "ratio_without_most", "ratio_without_by_wall"))):
            found = ratios(by_key, case, code, ranks, of, main)
            if found:
                by_wall = ratios(by_key, case, code, ranks, of, "rate_wall")
                kept |= dict(zip(names, (statistics.median(found), min(found), max(found), statistics.median(by_wall))))
        result.append(kept)
    return result


def peers_table():
    def ratio(r, name, key):
        return f"{number(r[name])} ({number(r[key + '_least'])} to {number(r[key + '_most'])})" if r[name] != "" else ""
    lines = ["| case | code | ranks | million particle-steps/s | tremie to this code | tremie without ledger to this code | "
             "kinetic energy [J] | contacts |", "|" + " --- |" * 8]
    for r in read("peers"):
        rate = f"{number(r[RATE])} ({number(r['rate_least'])} to {number(r['rate_most'])})"
        lines.append(f"| {name_of(r)} | {r['code']} | {r['ranks']} | {rate} | {ratio(r, RATIO, 'ratio')} | "
                     f"{ratio(r, RATIO_WITHOUT, 'ratio_without')} | {float(r['kinetic_J']):.3g} | {float(r['contacts']):.0f} |")
    return lines


def states_agree(rows):
    """Says whether codes are in the same state when a case's runs end: as many contacts and, where they move and have
    started from the same, as much kinetic energy."""
    agree = True
    for case in dict.fromkeys(r["case"] for r in rows):
        last = {key[1]: own[-1] for key, own in groups(rows).items() if key[0] == case}
        contacts = [r["contacts"] for r in last.values()]
        kinetic = [r["kinetic_J"] for r in last.values() if not r["own_packing"]]
        apart = max(contacts) / max(1, min(contacts)) - 1 if max(contacts) else 0
        energies = max(kinetic) / min(kinetic) - 1
        at_rest = all(r["rest_mass"] for r in last.values())
        fine = apart < APART and (at_rest or energies < APART)
        print(f"{case}: contacts differ by {100 * apart:.2g} %, kinetic energies by {100 * energies:.2g} %: "
              + ("alike" if fine else "NOT alike"))
        agree = agree and fine and all(case_is_at_rest([r]) for r in last.values())
    return agree


def beside_peers(rows):
    """Prints what is in peers.csv; fails where codes are not alike."""
    print("\n" + "\n".join(peers_table()) + "\n")
    return 0 if states_agree(rows) else 1


# ------------------------------------------------------------------------------------------------- walls

def wall_row(case, number, run, first, softness):
    """Of one round; `first` is the run beside it whose walls do not deform, `softness` the mesh's mean deflection under
    an even pressure over that of a fine one."""
    return {"hopper": case.name, "elements": case.what, "round": number, "steps": run.steps, "user_s": run.user,
            "over_rigid": run.user / first.user, "facets_s": run.phases["facets"], "solids_s": run.phases["solids"],
            "softness": softness, "machine": machine()}


def keep_walls(rows):
    write(os.path.join(codes.OUT, "walls.csv"), list(rows[0]), rows)


def walls_table():
    lines = ["| hopper | elements | deflection | user CPU time [s] | over rigid | of that facets [s] | elements [s] |",
             "|" + " --- |" * 7]
    rows = read("walls")
    for name in dict.fromkeys(r["hopper"] for r in rows):
        own = [r for r in rows if r["hopper"] == name]
        user, ratio, facets, solids = ([float(r[key]) for r in own] for key in ("user_s", "over_rigid", "facets_s", "solids_s"))
        lines.append(f"| {name} | {own[0]['elements'] or 0} | {number(own[0]['softness'])} | {spread(user, 1)} | {spread(ratio)} | "
                     f"{statistics.median(facets):.1f} | {statistics.median(solids):.1f} |")
    return lines


# ------------------------------------------------------------------------------------------------- README.md

TABLES = {"walls": walls_table, "suite": suite_table, "checkpoints": checkpoint_table, "mixtures": contact_table, "peers": peers_table}


def machines(name):
    return sorted({r["machine"] for r in read(name if name in ("peers", "walls") else "suite")})


def fill_tables():
    """Replaces what stands between `<!-- table NAME -->` and `<!-- end -->`."""
    file = os.path.join(codes.HERE, "README.md")
    text = open(file).read()
    for name, make in TABLES.items():
        lines = make()
        if len(lines) > 2:
            block = "\n".join([f"<!-- table {name} -->", "On " + " and ".join(machines(name)) + ":", "", *lines, "", "<!-- end -->"])
            text = re.sub(rf"<!-- table {name} -->.*?<!-- end -->", lambda _: block, text, flags=re.S)
    open(file, "w").write(text)
    return 0
