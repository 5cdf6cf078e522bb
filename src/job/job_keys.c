/*
 * Every key of a job file: type, unit, bounds, default, meaning.  The checks, the messages, the
 * job as used and the reference page (jobs/README.md) all come from here; adding a key is
 * adding a row.
 *
 * The bounds on lengths and speeds are far beyond any use: they keep sums and squares finite.
 */
#include "job/job_keys.h"

#include <math.h>

#include "job/job.h"
#include "job/sweep.h"

#define FAR 1e6 /* [m], [m/s], [rad/s] */

/* Where a member of a struct lies. */
#define AT(type, member) .offset = offsetof(type, member), .size = sizeof(((type *)0)->member)
#define GIVEN(type, member)                                                                    \
    .given = offsetof(type, member), .given_size = sizeof(((type *)0)->member)
#define LIST_AT(type, member, n)                                                               \
    .offset = offsetof(type, member), .count = offsetof(type, n),                              \
    .element = sizeof *((type *)0)->member

#define AT_LEAST(low) .bounds = SCHEMA_AT_LEAST, .min = (low)
#define ABOVE(low)    .bounds = SCHEMA_ABOVE, .min = (low)
#define BETWEEN(low, high)                                                                     \
    .bounds = SCHEMA_AT_LEAST | SCHEMA_AT_MOST, .min = (low), .max = (high)
#define UP_TO(high)         .bounds = SCHEMA_AT_MOST, .max = (high)
#define ABOVE_TO(low, high) .bounds = SCHEMA_ABOVE | SCHEMA_AT_MOST, .min = (low), .max = (high)
#define INSIDE(low, high)   .bounds = SCHEMA_ABOVE | SCHEMA_BELOW, .min = (low), .max = (high)

#define ZERO       "[0, 0, 0]"
#define KIND(kind) (1u << (kind))
#define END                                                                                    \
    {                                                                                          \
        .name = NULL                                                                           \
    }

static const char *const dimensions[] = {"3", NULL};
static const char *const laws[] = {"hertz-mindlin", "linear", NULL};
static const char *const pair_laws[] = {"hertz-mindlin", "linear", "default", NULL};
static const char *const rollings[] = {"spring", "constant", NULL};
static const char *const models[] = {"rigid", "solid", "shell", "membrane", NULL};
static const char *const shell_models[] = {"shell", "membrane", NULL};
static const char *const mesh_kinds[] = {"box", "plate", "cylinder", "tube", "gmsh", NULL};
static const char *const elements[] = {"hexahedra", "tetrahedra", NULL};
static const char *const hourglasses[] = {"stiffness", "viscous", NULL};
static const char *const touched[] = {"spheres", "bodies", "itself", NULL};
static const char *const packings[] = {"lattice", "hexagonal", "random", "csv", "hdf5", NULL};
static const char *const region_kinds[] = {"box", "cylinder", "sphere", "inside", NULL};
static const char *const sizes_kinds[] = {"list",      "uniform", "normal",
                                          "lognormal", "table",   NULL};
static const char *const sizes_bys[] = {"number", "mass", NULL};
static const char *const geometries[] = {
    "plane",          "box",  "hopper", "mesh", "cylinder", "cone",
    "conical-hopper", "tube", "stl",    "gmsh", NULL};
static const char *const caps[] = {"from", "to", NULL};
static const char *const sides[] = {"x_min", "x_max", "y_min", "y_max", "bottom", "top", NULL};
static const char *const section_kinds[] = {"plane", "disc", "rectangle", NULL};
static const char *const materials_only[] = {"material", NULL};
static const char *const splits[] = {"material", "size", NULL};
static const char *const drives[] = {"slide", "turn", NULL};
static const char *const spacings[] = {"linear", "log", NULL};
static const char *const fulls[] = {"wait", "stop", NULL};
static const char *const directions[] = {"x", "y", "z", NULL};
static const char *const leavers[] = {"stop", "remove", "ignore", NULL};
static const char *const weights[] = {"contacts", "candidates", NULL};
/* In the order of enum snapshot_field. */
static const char *const solid_fields[] = {"displacement",
                                           "velocity",
                                           "contact_force",
                                           "contact_pressure",
                                           "stress",
                                           "von_mises",
                                           "principal_stress",
                                           "plastic_strain",
                                           "thickness",
                                           "alive",
                                           NULL};
static const char *const snapshot_fields[] = {"velocity",
                                              "angular_velocity",
                                              "force",
                                              "torque",
                                              "mass",
                                              "material",
                                              "group",
                                              "dissipated_friction",
                                              "dissipated_damping",
                                              NULL};
static const char *const compressions[] = {"none", "lossless", NULL};
static const char *const precisions[] = {"double", "single", NULL};
static const char *const searches[] = {"auto", "all-pairs", NULL};

static const char *const velocities[] = {"keep", "zero", NULL};

static const struct schema_key start_group_keys[] = {{"name", SCHEMA_NAME, "name of the group",
                                                      .required = true,
                                                      AT(struct job_start_group, name)},
                                                     END};

static const struct schema_key start_keys[] = {
    {"from", SCHEMA_FILE,
     "folder of another job's run, for its newest checkpoint, or a checkpoint; materials and "
     "groups are matched by name, ids go on; not needed any more once the run has a checkpoint",
     .required = true, AT(struct job, start.from)},
    {"checkpoint", SCHEMA_TEXT,
     "name of the checkpoint in that folder, like step_000000002000.h5; when left out the newest "
     "as the run begins, filled in by the program: started again, the run takes the same",
     GIVEN(struct job, start.checkpoint), AT(struct job, start.checkpoint)},
    {"sum", SCHEMA_COUNT,
     "checksum of the checkpoint (CRC-32), filled in by the program: a run does not start from "
     "another one",
     .standard = "0", BETWEEN(0.0, 4294967295.0), AT(struct job, start.sum)},
    {"groups", SCHEMA_LIST,
     "groups of the other job that this one does not have itself, filled in by the program; "
     "their numbers follow those of `spheres` and `insert`",
     UP_TO(100000.0), .inside = start_group_keys, GIVEN(struct job, start.n_groups),
     LIST_AT(struct job, start.groups, start.n_groups)},
    {"velocities", SCHEMA_CHOICE, "keep velocities and spins, or set them to zero",
     .standard = "keep", .choices = velocities, AT(struct job, start.velocities)},
    END};

static const struct schema_key time_keys[] = {
    {"end", SCHEMA_NUMBER, "simulated time at which the run ends; a whole number of steps",
     .unit = "s", .required = true, ABOVE_TO(0.0, 1e9), AT(struct job, time.end)},
    {"step", SCHEMA_NUMBER,
     "time step; `auto` takes `safety` times the critical step of the scene", .unit = "s",
     .standard = "auto", ABOVE_TO(0.0, 1e3), .word = "auto", .word_value = 0.0,
     AT(struct job, time.step)},
    {"safety", SCHEMA_NUMBER, "share of the critical step that `step: auto` takes", .unit = "1",
     .standard = "0.2", ABOVE_TO(0.0, 1.0), AT(struct job, time.safety)},
    {"substeps", SCHEMA_INT,
     "steps that finite elements take in one of the spheres and of all contacts, whose forces stay "
     "as they are meanwhile: for elements much stiffer or smaller than spheres need",
     .standard = "1", BETWEEN(1.0, 1000.0), AT(struct job, time.substeps)},
    END};

static const struct schema_key hardening_table_keys[] = {
    {"strain", SCHEMA_NUMBER, "plastic strain, from 0 in the first row; ascending", .unit = "1",
     .required = true, BETWEEN(0.0, 1e3), AT(struct job_hardening, strain)},
    {"stress", SCHEMA_NUMBER, "stress at which the material yields then", .unit = "Pa",
     .required = true, ABOVE_TO(0.0, 1e15), AT(struct job_hardening, stress)},
    END};

static const struct schema_key material_keys[] = {
    {"density", SCHEMA_NUMBER, "mass per volume of the solid", .unit = "kg/m3",
     .required = true, ABOVE_TO(0.0, 1e9), AT(struct job_material, density)},
    {"young", SCHEMA_NUMBER, "Young's modulus", .unit = "Pa", .required = true,
     ABOVE_TO(0.0, 1e15), AT(struct job_material, young)},
    {"poisson", SCHEMA_NUMBER, "Poisson's ratio", .unit = "1", .required = true,
     INSIDE(-1.0, 0.5), AT(struct job_material, poisson)},
    {"yield", SCHEMA_NUMBER,
     "of a body that deforms: stress at which it begins to flow (von Mises); elastic when "
     "left out",
     .unit = "Pa", ABOVE_TO(0.0, 1e15), GIVEN(struct job_material, yield),
     AT(struct job_material, yield)},
    {"hardening", SCHEMA_NUMBER,
     "growth of that stress with plastic strain (isotropic); none when left out", .unit = "Pa",
     ABOVE_TO(0.0, 1e15), GIVEN(struct job_material, hardening),
     AT(struct job_material, hardening)},
    {"hardening_table", SCHEMA_LIST,
     "in place of yield and hardening: true stress over plastic strain, straight between the "
     "rows, constant behind the last",
     BETWEEN(1.0, 1000.0), GIVEN(struct job_material, n_hardening_table),
     .inside = hardening_table_keys,
     LIST_AT(struct job_material, hardening_table, n_hardening_table)},
    END};

static const struct schema_key pair_keys[] = {
    {"between", SCHEMA_REFERENCE, "the two materials, in any order; may be the same one twice",
     .required = true, .offset = offsetof(struct job_pair, a), .size = 2 * sizeof(int)},
    {"friction", SCHEMA_NUMBER, "Coulomb's coefficient of friction", .unit = "1",
     .required = true, BETWEEN(0.0, 100.0), AT(struct job_pair, friction)},
    {"restitution", SCHEMA_NUMBER,
     "speed after over speed before a straight impact: what comes out, damping is chosen so",
     .unit = "1", .required = true, BETWEEN(0.05, 1.0), AT(struct job_pair, restitution)},
    {"static_friction", SCHEMA_NUMBER,
     "friction of what does not slide yet, at least that of what slides; `friction` makes "
     "them equal",
     .unit = "1", .standard = "friction", BETWEEN(0.0, 100.0), .word = "friction",
     .word_value = -1.0, AT(struct job_pair, static_friction)},
    {"rolling_friction", SCHEMA_NUMBER,
     "greatest torque against rolling over the normal force times the effective radius",
     .unit = "1", .standard = "0", BETWEEN(0.0, 100.0), AT(struct job_pair, rolling_friction)},
    {"rolling", SCHEMA_CHOICE,
     "how rolling is resisted: a spring that gives way at that torque and holds what is at "
     "rest, or that torque whenever it rolls, which holds nothing",
     .standard = "spring", .choices = rollings, AT(struct job_pair, rolling)},
    {"twisting_friction", SCHEMA_NUMBER,
     "greatest torque against turning about the normal over the normal force times the "
     "effective radius; a spring holds up to it",
     .unit = "1", .standard = "0", BETWEEN(0.0, 100.0), AT(struct job_pair, twisting_friction)},
    {"law", SCHEMA_CHOICE, "the pair's own contact law; `default` is `contact.law`",
     .standard = "default", .choices = pair_laws, AT(struct job_pair, law)},
    {"stiffness", SCHEMA_NUMBER,
     "normal stiffness of the linear law; `default` is `contact.stiffness`", .unit = "N/m",
     .standard = "default", ABOVE_TO(0.0, 1e15), .word = "default", .word_value = 0.0,
     AT(struct job_pair, stiffness)},
    {"tangential_ratio", SCHEMA_NUMBER, "tangential over normal stiffness of the linear law",
     .unit = "1", .standard = "0.2857142857142857", ABOVE_TO(0.0, 100.0),
     AT(struct job_pair, tangential_ratio)},
    END};

static const struct schema_key contact_keys[] = {
    {"law", SCHEMA_CHOICE,
     "the contact law: stiffness from the materials' moduli that grows with the overlap, or "
     "springs of constant stiffness",
     .standard = "hertz-mindlin", .choices = laws, AT(struct job, law)},
    {"stiffness", SCHEMA_NUMBER,
     "normal stiffness of the linear law for pairs that give none of their own", .unit = "N/m",
     .standard = "none", ABOVE_TO(0.0, 1e15), .word = "none", .word_value = 0.0,
     AT(struct job, stiffness)},
    {"ledger", SCHEMA_FLAG,
     "keep account of energy: kinetic, potential, elastic, dissipated, work; costs little",
     .standard = "true", AT(struct job, energy_ledger)},
    {"pairs", SCHEMA_LIST,
     "what happens between two materials; every two that can meet need one (spheres among "
     "each other, spheres with bodies, bodies that touch bodies)",
     UP_TO(JOB_KEYS_MAX_PAIRS), .inside = pair_keys, LIST_AT(struct job, pairs, n_pairs)},
    END};

static const struct schema_key region_keys[] = {
    {"kind", SCHEMA_CHOICE, "the shape", .required = true, .choices = region_kinds,
     AT(struct job_region, kind)},
    {"min", SCHEMA_NUMBER, "least corner", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = KIND(JOB_REGION_BOX), AT(struct job_region, min)},
    {"max", SCHEMA_NUMBER, "greatest corner", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = KIND(JOB_REGION_BOX), AT(struct job_region, max)},
    {"from", SCHEMA_NUMBER, "one end of the axis", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), .kinds = KIND(JOB_REGION_CYLINDER), AT(struct job_region, from)},
    {"to", SCHEMA_NUMBER, "its other end", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = KIND(JOB_REGION_CYLINDER), AT(struct job_region, to)},
    {"centre", SCHEMA_NUMBER, "centre", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = KIND(JOB_REGION_SPHERE), AT(struct job_region, centre)},
    {"radius", SCHEMA_NUMBER, "radius", .unit = "m", .required = true, ABOVE_TO(0.0, FAR),
     .kinds = KIND(JOB_REGION_CYLINDER) | KIND(JOB_REGION_SPHERE),
     AT(struct job_region, radius)},
    {"body", SCHEMA_NAME,
     "a body whose surface is closed: the region is its inside, as it is at time 0",
     .required = true, .kinds = KIND(JOB_REGION_INSIDE), AT(struct job_region, body)},
    END};

#define WITH_LIMITS                                                                            \
    (KIND(JOB_SIZES_UNIFORM) | KIND(JOB_SIZES_NORMAL) | KIND(JOB_SIZES_LOGNORMAL))
#define WITH_MEAN (KIND(JOB_SIZES_NORMAL) | KIND(JOB_SIZES_LOGNORMAL))

static const struct schema_key size_keys[] = {
    {"radius", SCHEMA_NUMBER, "a radius; ascending in a table", .unit = "m", .required = true,
     ABOVE_TO(0.0, FAR), AT(struct job_size, radius)},
    {"share", SCHEMA_NUMBER,
     "list: the share of this radius, in parts of the sum of all; table: the share of all "
     "radii up to this one, from 0 for the first to 1 for the last",
     .unit = "1", .required = true, BETWEEN(0.0, 1e9), AT(struct job_size, share)},
    END};

static const struct schema_key sizes_keys[] = {
    {"kind", SCHEMA_CHOICE,
     "how radii are distributed: some radii; evenly; normally; their logarithm normally; by a "
     "cumulative curve (of sieves) that is straight between its points",
     .required = true, .choices = sizes_kinds, AT(struct job_sizes, kind)},
    {"by", SCHEMA_CHOICE, "the distribution is that of the number, or of the mass of spheres",
     .standard = "number", .choices = sizes_bys, AT(struct job_sizes, by)},
    {"min", SCHEMA_NUMBER, "least radius: smaller ones are cut off", .unit = "m",
     .required = true, ABOVE_TO(0.0, FAR), .kinds = WITH_LIMITS, AT(struct job_sizes, min)},
    {"max", SCHEMA_NUMBER, "greatest radius: greater ones are cut off", .unit = "m",
     .required = true, ABOVE_TO(0.0, FAR), .kinds = WITH_LIMITS, AT(struct job_sizes, max)},
    {"mean", SCHEMA_NUMBER, "mean radius before anything is cut off", .unit = "m",
     .required = true, ABOVE_TO(0.0, FAR), .kinds = WITH_MEAN, AT(struct job_sizes, mean)},
    {"deviation", SCHEMA_NUMBER, "standard deviation of the radius before anything is cut off",
     .unit = "m", .required = true, ABOVE_TO(0.0, FAR), .kinds = WITH_MEAN,
     AT(struct job_sizes, deviation)},
    {"radii", SCHEMA_LIST, "radii and their shares", .required = true, BETWEEN(1.0, 10000.0),
     .kinds = KIND(JOB_SIZES_LIST) | KIND(JOB_SIZES_TABLE), .inside = size_keys,
     LIST_AT(struct job_sizes, list, n)},
    END};

/* A region and a distribution of radii within another struct, and their own `given`. */
#define REGION_AT(type, member, flag)                                                          \
    .inside = region_keys, .offset = offsetof(type, member), GIVEN(type, flag)
#define SIZES_AT(type, member, flag)                                                           \
    .inside = sizes_keys, .offset = offsetof(type, member), GIVEN(type, flag)

#define LATTICES     (KIND(JOB_PACKING_LATTICE) | KIND(JOB_PACKING_HEXAGONAL))
#define PACKED_FILES (KIND(JOB_PACKING_CSV) | KIND(JOB_PACKING_HDF5))

static const struct schema_key packing_keys[] = {
    {"kind", SCHEMA_CHOICE, "how the group is placed at the start", .required = true,
     .choices = packings, AT(struct job_spheres, packing)},
    {"count", SCHEMA_COUNT,
     "number of spheres; in lattices rows along x, then y, then layers along z",
     BETWEEN(1.0, 2e9), .kinds = LATTICES | KIND(JOB_PACKING_RANDOM),
     GIVEN(struct job_spheres, count), AT(struct job_spheres, count)},
    {"mass", SCHEMA_NUMBER, "instead of count: their mass", .unit = "kg", ABOVE_TO(0.0, 1e30),
     .kinds = KIND(JOB_PACKING_RANDOM), GIVEN(struct job_spheres, mass),
     AT(struct job_spheres, mass)},
    {"fraction", SCHEMA_NUMBER,
     "instead of count: their volume over that of the region; equal spheres added at random "
     "reach 0.38 at most, less between near walls",
     .unit = "1", INSIDE(0.0, 1.0), .kinds = KIND(JOB_PACKING_RANDOM),
     GIVEN(struct job_spheres, fraction), AT(struct job_spheres, fraction)},
    {"region", SCHEMA_GROUP,
     "where spheres may be, wholly; where the domain repeats and the region spans the period, "
     "across the boundary too",
     .required = true, .kinds = KIND(JOB_PACKING_RANDOM),
     REGION_AT(struct job_spheres, region, region.given)},
    {"gap", SCHEMA_NUMBER,
     "least distance between the surfaces of a sphere and of others, those of groups before "
     "it included",
     .unit = "m", .standard = "0", BETWEEN(0.0, FAR), .kinds = KIND(JOB_PACKING_RANDOM),
     AT(struct job_spheres, gap)},
    {"attempts", SCHEMA_COUNT,
     "places to try for one sphere before giving up, soon only among those that may be free; "
     "the largest spheres are placed first",
     .standard = "10000", BETWEEN(1.0, 1e9), .kinds = KIND(JOB_PACKING_RANDOM),
     AT(struct job_spheres, attempts)},
    {"avoid_bodies", SCHEMA_FLAG,
     "keep clear of the surfaces of bodies that are there at time 0, and out of closed ones "
     "unless they hold most of the region",
     .standard = "true", .kinds = KIND(JOB_PACKING_RANDOM),
     AT(struct job_spheres, avoid_bodies)},
    {"spacing", SCHEMA_NUMBER, "distance between neighbouring centres; at least two radii",
     .unit = "m", .required = true, ABOVE_TO(0.0, FAR), .kinds = LATTICES,
     AT(struct job_spheres, spacing)},
    {"corner", SCHEMA_NUMBER,
     "least corner of the first cell; centres lie half a spacing inside", .unit = "m",
     .required = true, BETWEEN(-FAR, FAR), .kinds = LATTICES, AT(struct job_spheres, corner)},
    {"size", SCHEMA_NUMBER, "width of a layer along x and y", .unit = "m", .required = true,
     ABOVE_TO(0.0, FAR), .kinds = LATTICES, AT(struct job_spheres, size)},
    {"file", SCHEMA_FILE,
     "file, relative to the job file. CSV: its first line names the columns: x_m, y_m, z_m "
     "and, if wanted, radius_m, material, vx_m_s, vy_m_s, vz_m_s. HDF5, like a checkpoint: "
     "/spheres/position (n x 3) and, if wanted, radius (n), velocity, angular_velocity (n x "
     "3)",
     .required = true, .kinds = PACKED_FILES, AT(struct job_spheres, file)},
    {"sum", SCHEMA_COUNT,
     "checksum of the file (CRC-32), filled in by the program: a run is not resumed with "
     "another file's spheres",
     .standard = "0", BETWEEN(0.0, 4294967295.0), .kinds = PACKED_FILES,
     AT(struct job_spheres, sum)},
    END};

static const struct schema_key spheres_keys[] = {
    {"name", SCHEMA_NAME, "name of the group, used once", .required = true,
     AT(struct job_spheres, name)},
    {"material", SCHEMA_REFERENCE, "material (where a CSV file does not name one)",
     .required = true, AT(struct job_spheres, material)},
    {"radius", SCHEMA_NUMBER, "radius of all; may be left out where a file has radii",
     .unit = "m", ABOVE_TO(0.0, FAR), GIVEN(struct job_spheres, radius),
     AT(struct job_spheres, radius)},
    {"sizes", SCHEMA_GROUP, "radii that differ, instead of `radius`",
     SIZES_AT(struct job_spheres, sizes, sizes.given)},
    {"velocity", SCHEMA_NUMBER, "velocity at the start (where a file does not give it)",
     .unit = "m/s", .standard = ZERO, BETWEEN(-FAR, FAR), AT(struct job_spheres, velocity)},
    {"spin", SCHEMA_NUMBER, "angular velocity at the start", .unit = "rad/s", .standard = ZERO,
     BETWEEN(-FAR, FAR), AT(struct job_spheres, spin)},
    {"packing", SCHEMA_GROUP, "where the spheres are at the start", .required = true,
     .inside = packing_keys},
    END};

#define HOPPERS (KIND(JOB_GEOMETRY_HOPPER) | KIND(JOB_GEOMETRY_CONICAL_HOPPER))
#define CONES   (KIND(JOB_GEOMETRY_CONE) | KIND(JOB_GEOMETRY_CONICAL_HOPPER))
#define WITH_AXIS                                                                              \
    (KIND(JOB_GEOMETRY_CYLINDER) | KIND(JOB_GEOMETRY_CONE) | KIND(JOB_GEOMETRY_TUBE))
#define ROUND (WITH_AXIS | KIND(JOB_GEOMETRY_CONICAL_HOPPER))
#define FILES (KIND(JOB_GEOMETRY_STL) | KIND(JOB_GEOMETRY_GMSH))

static const struct schema_key rotate_keys[] = {
    {"axis", SCHEMA_DIRECTION, "direction of the axis; the right hand's thumb",
     .required = true, AT(struct job_body, turn_axis)},
    {"angle", SCHEMA_NUMBER, "angle of the rotation", .unit = "rad", .required = true,
     BETWEEN(-FAR, FAR), AT(struct job_body, turn_angle)},
    {"point", SCHEMA_NUMBER, "a point of the axis", .unit = "m", .standard = ZERO,
     BETWEEN(-FAR, FAR), AT(struct job_body, turn_point)},
    END};

/* How a shape or a mesh is placed. */
#define PLACE_KEYS                                                                             \
    {"scale",                                                                                  \
     SCHEMA_NUMBER,                                                                            \
     "factor on all coordinates, applied first: 0.001 for a file in mm",                       \
     .unit = "1",                                                                              \
     ABOVE_TO(0.0, 1e9),                                                                       \
     GIVEN(struct job_body, scale),                                                            \
     AT(struct job_body, scale)},                                                              \
        {"rotate", SCHEMA_GROUP, "a rotation, applied next", .inside = rotate_keys,            \
         GIVEN(struct job_body, turn_axis)},                                                   \
    {                                                                                          \
        "move", SCHEMA_NUMBER, "a shift, applied last", .unit = "m", BETWEEN(-FAR, FAR),       \
                                                        GIVEN(struct job_body, move),          \
                                                        AT(struct job_body, move)              \
    }

static const struct schema_key geometry_keys[] = {
    {"kind", SCHEMA_CHOICE, "the shape", .required = true, .choices = geometries,
     AT(struct job_body, geometry)},
    {"point", SCHEMA_NUMBER, "centre of the square", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), .kinds = KIND(JOB_GEOMETRY_PLANE), AT(struct job_body, point)},
    {"normal", SCHEMA_DIRECTION, "direction that the square faces", .required = true,
     .kinds = KIND(JOB_GEOMETRY_PLANE), AT(struct job_body, normal)},
    {"extent", SCHEMA_NUMBER, "edge of the square", .unit = "m", .required = true,
     ABOVE_TO(0.0, FAR), .kinds = KIND(JOB_GEOMETRY_PLANE), AT(struct job_body, extent)},
    {"min", SCHEMA_NUMBER, "least corner of the box", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), .kinds = KIND(JOB_GEOMETRY_BOX), AT(struct job_body, min)},
    {"max", SCHEMA_NUMBER, "greatest corner of the box", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), .kinds = KIND(JOB_GEOMETRY_BOX), AT(struct job_body, max)},
    {"open", SCHEMA_CHOICES, "sides that are left open", .standard = "[]", .choices = sides,
     .kinds = KIND(JOB_GEOMETRY_BOX), AT(struct job_body, open)},
    {"top", SCHEMA_NUMBER, "widths of the upper opening along x and y", .unit = "m",
     .required = true, ABOVE_TO(0.0, FAR), .kinds = KIND(JOB_GEOMETRY_HOPPER),
     AT(struct job_body, top)},
    {"outlet", SCHEMA_NUMBER, "widths of the outlet along x and y", .unit = "m",
     .required = true, ABOVE_TO(0.0, FAR), .kinds = KIND(JOB_GEOMETRY_HOPPER),
     AT(struct job_body, outlet)},
    {"z", SCHEMA_NUMBER, "heights of the outlet and of the upper opening", .unit = "m",
     .required = true, BETWEEN(-FAR, FAR), .kinds = HOPPERS, AT(struct job_body, z)},
    {"centre", SCHEMA_NUMBER, "x and y of the hopper's axis", .unit = "m", .standard = "[0, 0]",
     BETWEEN(-FAR, FAR), .kinds = HOPPERS, AT(struct job_body, centre)},
    {"from", SCHEMA_NUMBER, "one end of the axis", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), .kinds = WITH_AXIS, AT(struct job_body, from)},
    {"to", SCHEMA_NUMBER, "the other end", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = WITH_AXIS, AT(struct job_body, to)},
    {"radius", SCHEMA_NUMBER, "radius of the cylinder", .unit = "m", .required = true,
     ABOVE_TO(0.0, FAR), .kinds = KIND(JOB_GEOMETRY_CYLINDER), AT(struct job_body, radius)},
    {"radii", SCHEMA_NUMBER,
     "radii of the cone at `from` and `to`, one may be 0; of a hopper's outlet and upper "
     "opening",
     .unit = "m", .required = true, BETWEEN(0.0, FAR), .kinds = CONES,
     AT(struct job_body, radii)},
    {"inner", SCHEMA_NUMBER, "inner radius of the tube, whose wall is closed at its ends",
     .unit = "m", .required = true, ABOVE_TO(0.0, FAR), .kinds = KIND(JOB_GEOMETRY_TUBE),
     AT(struct job_body, inner)},
    {"outer", SCHEMA_NUMBER, "outer radius of the tube", .unit = "m", .required = true,
     ABOVE_TO(0.0, FAR), .kinds = KIND(JOB_GEOMETRY_TUBE), AT(struct job_body, outer)},
    {"caps", SCHEMA_CHOICES, "ends that are closed", .standard = "[]", .choices = caps,
     .kinds = KIND(JOB_GEOMETRY_CYLINDER) | KIND(JOB_GEOMETRY_CONE), AT(struct job_body, caps)},
    {"segments", SCHEMA_INT,
     "facets around the axis, 3 to 10000, corners on the circle: with N of them their middles "
     "lie inside it by 4.9/N2 of the radius, 0.1 % at 72; `exact` is the curved surface itself",
     .standard = "72", BETWEEN(3.0, 10000.0), .word = "exact", .word_value = 0.0,
     .kinds = ROUND, AT(struct job_body, segments)},
    {"file", SCHEMA_FILE,
     "the file, relative to the job file: STL or Gmsh's .msh of format 2.2 or 4.1, each ASCII "
     "or binary (little-endian)",
     .required = true, .kinds = FILES, AT(struct job_body, file)},
    {"sum", SCHEMA_COUNT,
     "checksum of the file (CRC-32), filled in by the program: a run is not resumed with "
     "another file's surface",
     .standard = "0", BETWEEN(0.0, 4294967295.0), .kinds = FILES, AT(struct job_body, sum)},
    {"group", SCHEMA_TEXT, "the physical group that is taken; all surfaces when left out",
     .kinds = KIND(JOB_GEOMETRY_GMSH), GIVEN(struct job_body, group),
     AT(struct job_body, group)},
    {"vertices", SCHEMA_POINTS, "corners of the facets", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), .kinds = KIND(JOB_GEOMETRY_MESH),
     LIST_AT(struct job_body, vertices, n_vertices)},
    {"facets", SCHEMA_FACETS,
     "triangles and quads as vertex numbers from 0, counter-clockwise seen from outside",
     .required = true, BETWEEN(0.0, 2147483647.0), .kinds = KIND(JOB_GEOMETRY_MESH),
     LIST_AT(struct job_body, facets, n_facets)},
    {"merge", SCHEMA_NUMBER,
     "vertices nearer to each other than this become one, before the shape is scaled; those in "
     "one place do so in any case",
     .unit = "m", ABOVE_TO(0.0, FAR), .kinds = FILES | KIND(JOB_GEOMETRY_MESH),
     GIVEN(struct job_body, merge), AT(struct job_body, merge)},
    PLACE_KEYS,
    END};

static const struct schema_key rotation_keys[] = {
    {"point", SCHEMA_NUMBER, "a point of the axis (it moves with the motion's translation)",
     .unit = "m", .required = true, BETWEEN(-FAR, FAR), AT(struct job_motion, pivot)},
    {"axis", SCHEMA_DIRECTION, "direction of the axis; the right hand's thumb",
     .required = true, AT(struct job_motion, axis)},
    {"rate", SCHEMA_NUMBER, "angular velocity about the axis", .unit = "rad/s",
     .required = true, BETWEEN(-FAR, FAR), AT(struct job_motion, rate)},
    END};

static const struct schema_key oscillation_keys[] = {
    {"direction", SCHEMA_DIRECTION, "along which it oscillates", .required = true,
     AT(struct job_motion, oscillation.direction)},
    {"amplitude", SCHEMA_NUMBER, "half of the way from end to end", .unit = "m",
     .required = true, ABOVE_TO(0.0, FAR), AT(struct job_motion, oscillation.amplitude)},
    {"frequency", SCHEMA_NUMBER, "cycles in a time", .unit = "1/s", .required = true,
     ABOVE_TO(0.0, FAR), AT(struct job_motion, oscillation.frequency)},
    {"phase", SCHEMA_NUMBER,
     "angle of the sine at `start`; the body begins where it is, whatever the phase",
     .unit = "rad", .standard = "0", BETWEEN(-100.0, 100.0),
     AT(struct job_motion, oscillation.phase)},
    END};

static const struct schema_key swing_keys[] = {
    {"point", SCHEMA_NUMBER, "a point of the axis (it moves with the motion's translation)",
     .unit = "m", .required = true, BETWEEN(-FAR, FAR), AT(struct job_motion, swing.pivot)},
    {"axis", SCHEMA_DIRECTION, "direction of the axis; the right hand's thumb",
     .required = true, AT(struct job_motion, swing.axis)},
    {"amplitude", SCHEMA_NUMBER, "half of the angle from end to end", .unit = "rad",
     .required = true, ABOVE_TO(0.0, FAR), AT(struct job_motion, swing.amplitude)},
    {"frequency", SCHEMA_NUMBER, "cycles in a time", .unit = "1/s", .required = true,
     ABOVE_TO(0.0, FAR), AT(struct job_motion, swing.frequency)},
    {"phase", SCHEMA_NUMBER, "angle of the sine at `start`", .unit = "rad", .standard = "0",
     BETWEEN(-100.0, 100.0), AT(struct job_motion, swing.phase)},
    END};

static const struct schema_key path_point_keys[] = {
    {"time", SCHEMA_NUMBER, "since `start`; ascending", .unit = "s", .required = true,
     BETWEEN(0.0, 1e9), AT(struct job_path_point, time)},
    {"place", SCHEMA_NUMBER,
     "where a point of the body is; the body moves by the differences from the first row",
     .unit = "m", .standard = ZERO, BETWEEN(-FAR, FAR), AT(struct job_path_point, place)},
    {"angle", SCHEMA_NUMBER, "about the path's axis; differences count likewise", .unit = "rad",
     .standard = "0", BETWEEN(-1e8, 1e8), AT(struct job_path_point, angle)},
    END};

static const struct schema_key path_keys[] = {
    {"points", SCHEMA_LIST,
     "places at times, with straight lines at constant speed between them; before the first "
     "and after the last the body rests",
     GIVEN(struct job_motion, path.n), BETWEEN(2.0, 20000.0), .inside = path_point_keys,
     LIST_AT(struct job_motion, path.points, path.n)},
    {"file", SCHEMA_FILE,
     "the same from a CSV file whose first line names the columns t_s and any of x_m, y_m, "
     "z_m and angle_rad",
     GIVEN(struct job_motion, path.file), AT(struct job_motion, path.file)},
    {"point", SCHEMA_NUMBER, "a point of the axis of `angle` (it moves with the path)",
     .unit = "m", .standard = ZERO, BETWEEN(-FAR, FAR), AT(struct job_motion, path.pivot)},
    {"axis", SCHEMA_DIRECTION, "direction of the axis of `angle`; required where one is given",
     GIVEN(struct job_motion, path.axis), AT(struct job_motion, path.axis)},
    END};

static const struct schema_key motion_keys[] = {
    {"velocity", SCHEMA_NUMBER, "velocity of translation", .unit = "m/s", .standard = ZERO,
     BETWEEN(-FAR, FAR), AT(struct job_motion, velocity)},
    {"rotation", SCHEMA_GROUP, "rotation about an axis", .inside = rotation_keys,
     GIVEN(struct job_motion, axis)},
    {"oscillation", SCHEMA_GROUP,
     "to and fro along a direction: amplitude x (sin(2 pi frequency t + phase) - sin(phase))",
     .inside = oscillation_keys, GIVEN(struct job_motion, oscillation.direction)},
    {"swing", SCHEMA_GROUP,
     "to and fro about an axis, likewise; a motion has one of rotation, swing and path.axis",
     .inside = swing_keys, GIVEN(struct job_motion, swing.axis)},
    {"path", SCHEMA_GROUP, "a tabulated path", .inside = path_keys,
     GIVEN(struct job_motion, path.given)},
    {"start", SCHEMA_NUMBER, "when the motion begins", .unit = "s", .standard = "0",
     BETWEEN(0.0, 1e9), AT(struct job_motion, start)},
    {"stop", SCHEMA_NUMBER, "when it ends", .unit = "s", .standard = "never", AT_LEAST(0.0),
     .word = "never", .word_value = INFINITY, AT(struct job_motion, stop)},
    END};

static const struct schema_key surface_rotation_keys[] = {
    {"point", SCHEMA_NUMBER, "a point of the axis", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), AT(struct job_motion, pivot)},
    {"axis", SCHEMA_DIRECTION, "direction of the axis; the right hand's thumb",
     .required = true, AT(struct job_motion, axis)},
    {"rate", SCHEMA_NUMBER, "angular velocity about the axis", .unit = "rad/s",
     .required = true, BETWEEN(-FAR, FAR), AT(struct job_motion, rate)},
    END};

static const struct schema_key surface_keys[] = {
    {"velocity", SCHEMA_NUMBER, "velocity that it runs with", .unit = "m/s", .standard = ZERO,
     BETWEEN(-FAR, FAR), AT(struct job_motion, velocity)},
    {"rotation", SCHEMA_GROUP, "rotation that it runs with, like that of a roller",
     .inside = surface_rotation_keys, GIVEN(struct job_motion, axis)},
    {"start", SCHEMA_NUMBER, "when it begins to run", .unit = "s", .standard = "0",
     BETWEEN(0.0, 1e9), AT(struct job_motion, start)},
    {"stop", SCHEMA_NUMBER, "when it stops", .unit = "s", .standard = "never", AT_LEAST(0.0),
     .word = "never", .word_value = INFINITY, AT(struct job_motion, stop)},
    END};

static const struct schema_key driven_keys[] = {
    {"kind", SCHEMA_CHOICE, "slide along the axis, or turn about it", .required = true,
     .choices = drives, AT(struct job_body, driven.kind)},
    {"axis", SCHEMA_DIRECTION, "direction that counts as positive, or the right hand's thumb",
     .required = true, AT(struct job_body, driven.axis)},
    {"point", SCHEMA_NUMBER, "a point of the axis", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), .kinds = KIND(JOB_DRIVE_TURN), AT(struct job_body, driven.point)},
    {"mass", SCHEMA_NUMBER, "mass; gravity along the axis acts on it", .unit = "kg",
     .required = true, ABOVE_TO(0.0, 1e12), .kinds = KIND(JOB_DRIVE_SLIDE),
     AT(struct job_body, driven.mass)},
    {"inertia", SCHEMA_NUMBER,
     "moment of inertia about the axis; the centre of mass lies on the axis", .unit = "kg m2",
     .required = true, ABOVE_TO(0.0, 1e12), .kinds = KIND(JOB_DRIVE_TURN),
     AT(struct job_body, driven.inertia)},
    {"force", SCHEMA_NUMBER, "applied force along the axis, besides gravity", .unit = "N",
     .standard = "0", BETWEEN(-1e12, 1e12), .kinds = KIND(JOB_DRIVE_SLIDE),
     AT(struct job_body, driven.force)},
    {"torque", SCHEMA_NUMBER, "applied torque about the axis", .unit = "N m", .standard = "0",
     BETWEEN(-1e12, 1e12), .kinds = KIND(JOB_DRIVE_TURN), AT(struct job_body, driven.torque)},
    {"speed", SCHEMA_NUMBER, "speed along the axis at the start", .unit = "m/s",
     .standard = "0", BETWEEN(-FAR, FAR), .kinds = KIND(JOB_DRIVE_SLIDE),
     AT(struct job_body, driven.speed)},
    {"rate", SCHEMA_NUMBER, "angular velocity about the axis at the start", .unit = "rad/s",
     .standard = "0", BETWEEN(-FAR, FAR), .kinds = KIND(JOB_DRIVE_TURN),
     AT(struct job_body, driven.rate)},
    {"damping", SCHEMA_NUMBER,
     "a force of -damping x mass x speed, or a torque of -damping x inertia x rate",
     .unit = "1/s", .standard = "0", BETWEEN(0.0, 1e9), AT(struct job_body, driven.damping)},
    {"friction", SCHEMA_NUMBER, "dry friction of the guide: the most it holds against",
     .unit = "N", .standard = "0", BETWEEN(0.0, 1e12), .kinds = KIND(JOB_DRIVE_SLIDE),
     AT(struct job_body, driven.friction)},
    {"drag", SCHEMA_NUMBER, "dry friction of the bearing: the most it holds against",
     .unit = "N m", .standard = "0", BETWEEN(0.0, 1e12), .kinds = KIND(JOB_DRIVE_TURN),
     AT(struct job_body, driven.drag)},
    {"travel", SCHEMA_NUMBER,
     "least and greatest way along the axis from the place at the start; stops that take all "
     "speed; without limits when left out",
     .unit = "m", BETWEEN(-FAR, FAR), .kinds = KIND(JOB_DRIVE_SLIDE),
     GIVEN(struct job_body, driven.limited), AT(struct job_body, driven.travel)},
    {"angles", SCHEMA_NUMBER, "least and greatest angle, likewise", .unit = "rad",
     BETWEEN(-1e8, 1e8), .kinds = KIND(JOB_DRIVE_TURN), GIVEN(struct job_body, driven.limited),
     AT(struct job_body, driven.angles)},
    {"start", SCHEMA_NUMBER, "when it is released; held until then", .unit = "s",
     .standard = "0", BETWEEN(0.0, 1e9), AT(struct job_body, driven.start)},
    END};

static const struct schema_key free_keys[] = {
    {"density", SCHEMA_NUMBER,
     "mass per volume of what the surface encloses, which gives mass, centre and inertia; the "
     "surface must be closed",
     .unit = "kg/m3", ABOVE_TO(0.0, 1e9), GIVEN(struct job_body, free.density),
     AT(struct job_body, free.density)},
    {"mass", SCHEMA_NUMBER, "mass, with `inertia` and `centre`, in place of `density`",
     .unit = "kg", ABOVE_TO(0.0, 1e12), GIVEN(struct job_body, free.mass),
     AT(struct job_body, free.mass)},
    {"inertia", SCHEMA_NUMBER,
     "tensor of inertia about the centre of mass: xx, yy, zz, xy, xz, yz", .unit = "kg m2",
     BETWEEN(-1e12, 1e12), GIVEN(struct job_body, free.has_inertia),
     AT(struct job_body, free.inertia)},
    {"centre", SCHEMA_NUMBER, "centre of mass at the start", .unit = "m", BETWEEN(-FAR, FAR),
     GIVEN(struct job_body, free.has_centre), AT(struct job_body, free.centre)},
    {"velocity", SCHEMA_NUMBER, "velocity of the centre at the start", .unit = "m/s",
     .standard = ZERO, BETWEEN(-FAR, FAR), AT(struct job_body, free.velocity)},
    {"spin", SCHEMA_NUMBER, "angular velocity at the start", .unit = "rad/s", .standard = ZERO,
     BETWEEN(-FAR, FAR), AT(struct job_body, free.spin)},
    {"damping", SCHEMA_NUMBER,
     "a force of -damping x mass x velocity, and -damping x the angular momentum as torque",
     .unit = "1/s", .standard = "0", BETWEEN(0.0, 1e9), AT(struct job_body, free.damping)},
    {"start", SCHEMA_NUMBER, "when it is released; held until then", .unit = "s",
     .standard = "0", BETWEEN(0.0, 1e9), AT(struct job_body, free.start)},
    END};

#define MESH_FILES     KIND(JOB_MESH_GMSH)
#define MESH_CORNERS   KIND(JOB_MESH_BOX)
#define MESH_PLATES    KIND(JOB_MESH_PLATE)
#define MESH_CYLINDERS KIND(JOB_MESH_CYLINDER)
#define MESH_TUBES     KIND(JOB_MESH_TUBE)
#define MESH_AXES      (MESH_CYLINDERS | MESH_TUBES)
#define MESH_SHAPES    (MESH_CORNERS | MESH_PLATES | MESH_AXES)

static const struct schema_key solid_mesh_keys[] = {
    {"kind", SCHEMA_CHOICE,
     "the shape. Sets that come with it: `all`, `surface`; `bottom`, `top` (at `from`, `to`); of "
     "box and plate `x_min`, `x_max`, `y_min`, `y_max`, `z_min`, `z_max` and `side`, the four "
     "of x and y; of a cylinder `side`; of a tube `inside`, `outside`; of a file its physical "
     "groups",
     .required = true, .choices = mesh_kinds, AT(struct job_body, solid.kind)},
    {"min", SCHEMA_NUMBER, "least corner", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = MESH_CORNERS, AT(struct job_body, min)},
    {"max", SCHEMA_NUMBER, "greatest corner", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = MESH_CORNERS, AT(struct job_body, max)},
    {"corner", SCHEMA_NUMBER, "least corner", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = MESH_PLATES, AT(struct job_body, solid.corner)},
    {"size", SCHEMA_NUMBER, "sides along x and y", .unit = "m", .required = true,
     ABOVE_TO(0.0, FAR), .kinds = MESH_PLATES, AT(struct job_body, solid.size)},
    {"thickness", SCHEMA_NUMBER, "thickness, along z", .unit = "m", .required = true,
     ABOVE_TO(0.0, FAR), .kinds = MESH_PLATES, AT(struct job_body, solid.thickness)},
    {"from", SCHEMA_NUMBER, "one end of the axis", .unit = "m", .required = true,
     BETWEEN(-FAR, FAR), .kinds = MESH_AXES, AT(struct job_body, from)},
    {"to", SCHEMA_NUMBER, "the other end", .unit = "m", .required = true, BETWEEN(-FAR, FAR),
     .kinds = MESH_AXES, AT(struct job_body, to)},
    {"radius", SCHEMA_NUMBER, "radius", .unit = "m", .required = true, ABOVE_TO(0.0, FAR),
     .kinds = MESH_CYLINDERS, AT(struct job_body, radius)},
    {"inner", SCHEMA_NUMBER, "inner radius", .unit = "m", .required = true, ABOVE_TO(0.0, FAR),
     .kinds = MESH_TUBES, AT(struct job_body, inner)},
    {"outer", SCHEMA_NUMBER, "outer radius", .unit = "m", .required = true, ABOVE_TO(0.0, FAR),
     .kinds = MESH_TUBES, AT(struct job_body, outer)},
    {"cells", SCHEMA_INT,
     "numbers of cells: box and plate: along x, y and z; cylinder: across its square core, which "
     "are a quarter of those around, from there to the rim, along the axis; tube: around, "
     "through the wall, along the axis",
     BETWEEN(1.0, 1e6), .kinds = MESH_SHAPES, GIVEN(struct job_body, solid.cells),
     AT(struct job_body, solid.cells)},
    {"cell", SCHEMA_NUMBER, "in place of `cells`: the width that a cell should have at most",
     .unit = "m", ABOVE_TO(0.0, FAR), .kinds = MESH_SHAPES, GIVEN(struct job_body, solid.cell),
     AT(struct job_body, solid.cell)},
    {"elements", SCHEMA_CHOICE, "a cell is a hexahedron, or cut into six tetrahedra",
     .standard = "hexahedra", .choices = elements, .kinds = MESH_SHAPES,
     AT(struct job_body, solid.elements)},
    {"file", SCHEMA_FILE,
     "the file, relative to the job file: Gmsh's .msh of format 2.2 or 4.1, ASCII or binary "
     "(little-endian), of hexahedra with 8 and tetrahedra with 4 nodes",
     .required = true, .kinds = MESH_FILES, AT(struct job_body, file)},
    {"sum", SCHEMA_COUNT,
     "checksum of the file (CRC-32), filled in by the program: a run is not resumed with "
     "another file's mesh",
     .standard = "0", BETWEEN(0.0, 4294967295.0), .kinds = MESH_FILES,
     AT(struct job_body, sum)},
    {"group", SCHEMA_TEXT,
     "the physical volume that is taken, with the nodes that it has; all elements when left out",
     .kinds = MESH_FILES, GIVEN(struct job_body, group), AT(struct job_body, group)},
    PLACE_KEYS,
    END};

static const struct schema_key set_keys[] = {
    {"name", SCHEMA_NAME, "name of the set, that no other set of the body has",
     .required = true, AT(struct job_set, name)},
    {"region", SCHEMA_GROUP,
     "nodes that lie in it at time 0, its border included, the elements all of whose nodes do, and "
     "likewise the sides of elements on the surface; a box, cylinder or sphere",
     .required = true, REGION_AT(struct job_set, region, region.given)},
    END};

#define VALUE_AT .required = true, AT(struct job_value, value)
#define TIME_ROW                                                                               \
    {                                                                                          \
        "time", SCHEMA_NUMBER,                                                                 \
            "ascending; before the first and after the last row it is constant",               \
            .unit = "s", .required = true, BETWEEN(0.0, 1e9), AT(struct job_value, time)       \
    }

static const struct schema_key displacement_keys[] = {
    TIME_ROW,
    {"displacement", SCHEMA_NUMBER, "from the place at the start; 0 at time 0", .unit = "m",
     BETWEEN(-FAR, FAR), VALUE_AT},
    END};
static const struct schema_key velocity_keys[] = {TIME_ROW,
                                                  {"velocity", SCHEMA_NUMBER,
                                                   "velocity at that time", .unit = "m/s",
                                                   BETWEEN(-FAR, FAR), VALUE_AT},
                                                  END};
static const struct schema_key force_keys[] = {
    TIME_ROW,
    {"force", SCHEMA_NUMBER, "force at that time", .unit = "N", BETWEEN(-1e12, 1e12), VALUE_AT},
    END};
static const struct schema_key pressure_keys[] = {TIME_ROW,
                                                  {"pressure", SCHEMA_NUMBER,
                                                   "pressure at that time", .unit = "Pa",
                                                   BETWEEN(-1e15, 1e15), VALUE_AT},
                                                  END};

static const struct schema_key boundary_keys[] = {
    {"set", SCHEMA_TEXT, "name of a set of the body: of its mesh, its file, or of `sets`",
     .required = true, AT(struct job_boundary, set)},
    {"fixed", SCHEMA_CHOICES,
     "directions in which its nodes stay where they are; an item of the list has one of fixed, "
     "fixed_turns, motion, displacement_table, velocity, force, pressure or one of their tables",
     .choices = directions, GIVEN(struct job_boundary, fixed), AT(struct job_boundary, fixed)},
    {"fixed_turns", SCHEMA_CHOICES, "axes about which its nodes, those of a shell, do not turn",
     .choices = directions, GIVEN(struct job_boundary, fixed_turns),
     AT(struct job_boundary, fixed_turns)},
    {"motion", SCHEMA_LIST,
     "a motion that its nodes follow, and turn with, as a rigid body would; one, or several as "
     "in a body's `motion`",
     .single = true, GIVEN(struct job_boundary, n_motions), BETWEEN(1.0, 100.0),
     .inside = motion_keys, LIST_AT(struct job_boundary, motions, n_motions)},
    {"direction", SCHEMA_CHOICE, "direction of displacement, velocity or force",
     .choices = directions, GIVEN(struct job_boundary, has_direction),
     AT(struct job_boundary, direction)},
    {"displacement_table", SCHEMA_LIST, "displacement of its nodes over time",
     BETWEEN(1.0, 10000.0), GIVEN(struct job_boundary, n_displacements),
     .inside = displacement_keys, LIST_AT(struct job_boundary, displacements, n_displacements)},
    {"velocity", SCHEMA_NUMBER, "velocity of its nodes", .unit = "m/s", BETWEEN(-FAR, FAR),
     GIVEN(struct job_boundary, has_velocity), AT(struct job_boundary, velocity)},
    {"velocity_table", SCHEMA_LIST, "velocity of its nodes over time", BETWEEN(1.0, 10000.0),
     GIVEN(struct job_boundary, n_velocities), .inside = velocity_keys,
     LIST_AT(struct job_boundary, velocities, n_velocities)},
    {"force", SCHEMA_NUMBER, "force on all of its nodes together, each bears an equal share",
     .unit = "N", BETWEEN(-1e12, 1e12), GIVEN(struct job_boundary, has_force),
     AT(struct job_boundary, force)},
    {"force_table", SCHEMA_LIST, "such a force over time", BETWEEN(1.0, 10000.0),
     GIVEN(struct job_boundary, n_forces), .inside = force_keys,
     LIST_AT(struct job_boundary, forces, n_forces)},
    {"pressure", SCHEMA_NUMBER,
     "pressure on the sides of its elements; positive pushes inwards", .unit = "Pa",
     BETWEEN(-1e15, 1e15), GIVEN(struct job_boundary, has_pressure),
     AT(struct job_boundary, pressure)},
    {"pressure_table", SCHEMA_LIST, "pressure over time", BETWEEN(1.0, 10000.0),
     GIVEN(struct job_boundary, n_pressures), .inside = pressure_keys,
     LIST_AT(struct job_boundary, pressures, n_pressures)},
    END};

static const struct schema_key mass_keys[] = {
    {"set", SCHEMA_TEXT, "name of a set of the body: its nodes", .required = true,
     AT(struct job_mass, set)},
    {"mass", SCHEMA_NUMBER, "shared evenly by the nodes of this set", .unit = "kg",
     .required = true, ABOVE_TO(0.0, 1e12), AT(struct job_mass, mass)},
    {"inertia", SCHEMA_NUMBER,
     "moment of inertia about any axis, shared likewise; nodes of shells alone have it",
     .unit = "kg m2", .standard = "0", BETWEEN(0.0, 1e12), AT(struct job_mass, inertia)},
    END};

static const struct schema_key solid_damping_keys[] = {
    {"mass", SCHEMA_NUMBER, "a force of -mass x nodal mass x velocity on each node",
     .unit = "1/s", .standard = "0", BETWEEN(0.0, 1e9),
     AT(struct job_body, solid.damping.mass)},
    {"stiffness", SCHEMA_NUMBER,
     "a stress of stiffness x the rate of elastic stress; it lowers the critical step",
     .unit = "s", .standard = "0", BETWEEN(0.0, 1e3),
     AT(struct job_body, solid.damping.stiffness)},
    END};

static const struct schema_key hourglass_keys[] = {
    {"kind", SCHEMA_CHOICE,
     "what holds the shapes that the one point of a hexahedron does not feel: springs or "
     "dashpots",
     .standard = "stiffness", .choices = hourglasses,
     AT(struct job_body, solid.hourglass.kind)},
    {"coefficient", SCHEMA_NUMBER, "its strength", .unit = "1", .standard = "0.05",
     BETWEEN(0.0, 1.0), AT(struct job_body, solid.hourglass.coefficient)},
    END};

static const struct schema_key touches_keys[] = {
    {"what", SCHEMA_CHOICE,
     "spheres alone; all other bodies besides; these and its own surface, where that was apart "
     "at the start",
     .standard = "spheres", .choices = touched, AT(struct job_body, solid.touches.what)},
    {"stiffness", SCHEMA_NUMBER,
     "of a node's spring, over the lesser of the two moduli times the node's share of the "
     "surface over the depth of its elements; what is more than some 0.5 lowers the critical "
     "step",
     .unit = "1", .standard = "0.5", BETWEEN(0.001, 1000.0),
     AT(struct job_body, solid.touches.stiffness)},
    END};

static const struct schema_key thickness_keys[] = {
    {"set", SCHEMA_TEXT, "name of a set of the body: its elements", .required = true,
     AT(struct job_thickness, set)},
    {"thickness", SCHEMA_NUMBER, "how thick they are", .unit = "m", .required = true,
     ABOVE_TO(0.0, FAR), AT(struct job_thickness, thickness)},
    END};

static const struct schema_key shell_keys[] = {
    {"set", SCHEMA_TEXT,
     "name of a set of the body: its sides; of a Gmsh file also facets of its surfaces that are "
     "no sides of elements, with their nodes",
     .required = true, AT(struct job_shell, set)},
    {"thickness", SCHEMA_NUMBER, "how thick they are, half of it on each side of the nodes",
     .unit = "m", .required = true, ABOVE_TO(0.0, FAR), AT(struct job_shell, thickness)},
    {"model", SCHEMA_CHOICE, "whether they resist bending", .standard = "shell",
     .choices = shell_models, AT(struct job_shell, model)},
    {"material", SCHEMA_REFERENCE,
     "what they are made of, the body's when left out; contacts are those of the body's",
     GIVEN(struct job_shell, has_material), AT(struct job_shell, material)},
    END};

#define RIGID   KIND(JOB_MODEL_RIGID)
#define SOLID   KIND(JOB_MODEL_SOLID)
#define SHELL   KIND(JOB_MODEL_SHELL)
#define SHEETS  (SHELL | KIND(JOB_MODEL_MEMBRANE))
#define DEFORMS (SOLID | SHEETS)

static const struct schema_key body_keys[] = {
    {"name", SCHEMA_NAME, "name of the body, used once", .required = true,
     AT(struct job_body, name)},
    {"material", SCHEMA_REFERENCE, "material of its surface", .required = true,
     AT(struct job_body, material)},
    {"model", SCHEMA_CHOICE,
     "how it deforms: not at all, or by finite elements, as a solid, as a shell, which bends, or as "
     "a membrane, which does not resist bending",
     .standard = "rigid", .choices = models, AT(struct job_body, model)},
    {"geometry", SCHEMA_GROUP,
     "its surface. Sets that come with a shell or membrane: `all`, `surface`; `rim`, its free "
     "edges",
     .required = true, .kinds = RIGID | SHEETS, .inside = geometry_keys},
    {"thickness", SCHEMA_NUMBER,
     "how thick it is, half of it on each side of its geometry; shells and membranes need it. Of a "
     "rigid body it changes nothing: `tremie check --advise` judges by it",
     .unit = "m", ABOVE_TO(0.0, FAR), .kinds = RIGID | SHEETS,
     GIVEN(struct job_body, sheet.thickness), AT(struct job_body, sheet.thickness)},
    {"thicknesses", SCHEMA_LIST, "of sets with other thicknesses", UP_TO(1000.0),
     .kinds = RIGID | SHEETS, .inside = thickness_keys,
     GIVEN(struct job_body, solid.n_thicknesses),
     LIST_AT(struct job_body, solid.thicknesses, solid.n_thicknesses)},
    {"cell", SCHEMA_NUMBER,
     "the width that an element should have at most; when left out each facet is one element. A rigid "
     "body may have this, thicknesses, sets and boundary as well, and does not use them",
     .unit = "m", ABOVE_TO(0.0, FAR), .kinds = RIGID | SHEETS,
     GIVEN(struct job_body, sheet.cell), AT(struct job_body, sheet.cell)},
    {"layers", SCHEMA_INT,
     "points through the thickness at which it is found whether it flows; 2 are exact while it "
     "does not",
     .standard = "3", BETWEEN(1.0, 5.0), .kinds = SHELL | SOLID,
     AT(struct job_body, sheet.layers)},
    {"mesh", SCHEMA_GROUP, "its elements", .required = true, .kinds = SOLID,
     .inside = solid_mesh_keys},
    {"shells", SCHEMA_LIST,
     "shells and membranes that share nodes with it, as a liner on its surface does",
     UP_TO(1000.0), .kinds = SOLID, .inside = shell_keys,
     GIVEN(struct job_body, solid.n_shells),
     LIST_AT(struct job_body, solid.shells, solid.n_shells)},
    {"sets", SCHEMA_LIST, "parts of it besides those that its mesh has", UP_TO(1000.0),
     .kinds = RIGID | DEFORMS, .inside = set_keys, GIVEN(struct job_body, solid.n_sets),
     LIST_AT(struct job_body, solid.sets, solid.n_sets)},
    {"boundary", SCHEMA_LIST, "what is prescribed on its sets; free elsewhere", UP_TO(1000.0),
     .kinds = RIGID | DEFORMS, .inside = boundary_keys,
     GIVEN(struct job_body, solid.n_boundary),
     LIST_AT(struct job_body, solid.boundary, solid.n_boundary)},
    {"masses", SCHEMA_LIST, "masses that its sets bear besides their elements' own",
     UP_TO(1000.0), .kinds = DEFORMS, .inside = mass_keys,
     GIVEN(struct job_body, solid.n_masses),
     LIST_AT(struct job_body, solid.masses, solid.n_masses)},
    {"velocity", SCHEMA_NUMBER, "velocity of all its nodes at the start", .unit = "m/s",
     .standard = ZERO, BETWEEN(-FAR, FAR), .kinds = DEFORMS,
     AT(struct job_body, solid.velocity)},
    {"damping", SCHEMA_GROUP, "Rayleigh's damping", .kinds = DEFORMS,
     .inside = solid_damping_keys},
    {"hourglass", SCHEMA_GROUP,
     "hourglass control of hexahedra and quads; what holds quads are springs in any case",
     .kinds = DEFORMS, .inside = hourglass_keys},
    {"touches", SCHEMA_GROUP, "what its nodes touch; its faces touch whatever touches them",
     .kinds = SOLID, .inside = touches_keys},
    {"motion", SCHEMA_LIST,
     "how it moves as prescribed; one mapping, or several in sequence or together: each moves "
     "what those before it have made of the body, about points and along directions fixed in "
     "space",
     .single = true, GIVEN(struct job_body, n_motions), BETWEEN(1.0, 100.0), .kinds = RIGID,
     .inside = motion_keys, LIST_AT(struct job_body, motions, n_motions)},
    {"driven", SCHEMA_GROUP,
     "moved along or about one axis by forces, those of the spheres and others: a piston under "
     "a load, a drum on its bearings; in place of `motion`",
     .kinds = RIGID, .inside = driven_keys, GIVEN(struct job_body, driven.given)},
    {"free", SCHEMA_GROUP,
     "moved in all directions by gravity and the spheres, in place of `motion`; of other bodies "
     "it feels those that deform and touch bodies",
     .kinds = RIGID, .inside = free_keys, GIVEN(struct job_body, free.given)},
    {"surface", SCHEMA_GROUP,
     "its surface runs, like a belt, while the body stays where it is or moves as prescribed: "
     "of the velocity, fixed in space, what lies in the plane of contact acts",
     .kinds = RIGID, .inside = surface_keys,
     .offset = offsetof(struct job_body, surface.motion),
     GIVEN(struct job_body, surface.given)},
    {"active", SCHEMA_NUMBER,
     "times between which it is there, like a plug that is drawn; always when left out",
     .unit = "s", BETWEEN(0.0, 1e9), .kinds = RIGID, GIVEN(struct job_body, comes_and_goes),
     AT(struct job_body, active)},
    END};

static const struct schema_key damping_region_keys[] = {
    {"region", SCHEMA_GROUP, "where: of spheres whose centres are there", .required = true,
     REGION_AT(struct job_damping_region, region, region.given)},
    {"damping", SCHEMA_NUMBER, "there, besides `damping`", .unit = "1/s", .required = true,
     BETWEEN(0.0, 1e9), AT(struct job_damping_region, damping)},
    END};

static const struct schema_key gravity_turn_keys[] = {
    {"axis", SCHEMA_DIRECTION, "about which gravity turns; the right hand's thumb",
     .required = true, AT(struct job, gravity_turn.axis)},
    {"rate", SCHEMA_NUMBER, "angular velocity of its direction", .unit = "rad/s",
     .required = true, BETWEEN(-FAR, FAR), AT(struct job, gravity_turn.rate)},
    {"start", SCHEMA_NUMBER, "when it begins to turn", .unit = "s", .standard = "0",
     BETWEEN(0.0, 1e9), AT(struct job, gravity_turn.start)},
    {"stop", SCHEMA_NUMBER, "when it ends", .unit = "s", .standard = "never", AT_LEAST(0.0),
     .word = "never", .word_value = INFINITY, AT(struct job, gravity_turn.stop)},
    END};

static const struct schema_key gravity_table_keys[] = {
    {"time", SCHEMA_NUMBER, "ascending; before the first and after the last it is constant",
     .unit = "s", .required = true, BETWEEN(0.0, 1e9), AT(struct job_gravity, time)},
    {"gravity", SCHEMA_NUMBER, "acceleration at that time; linear in between", .unit = "m/s2",
     .required = true, BETWEEN(-FAR, FAR), AT(struct job_gravity, gravity)},
    END};

static const struct schema_key section_keys[] = {
    {"name", SCHEMA_NAME, "name of the section, used once", .required = true,
     AT(struct job_section, name)},
    {"kind", SCHEMA_CHOICE,
     "all of a plane, or a part of it: who passes beside it is not counted",
     .standard = "plane", .choices = section_kinds, AT(struct job_section, kind)},
    {"point", SCHEMA_NUMBER, "a point of the plane; the centre of a disc or a rectangle",
     .unit = "m", .required = true, BETWEEN(-FAR, FAR), AT(struct job_section, point)},
    {"normal", SCHEMA_DIRECTION, "direction that counts as forward", .required = true,
     AT(struct job_section, normal)},
    {"radius", SCHEMA_NUMBER, "radius of the disc; centres count that pass within", .unit = "m",
     .required = true, ABOVE_TO(0.0, FAR), .kinds = KIND(JOB_SECTION_DISC),
     AT(struct job_section, radius)},
    {"across", SCHEMA_DIRECTION,
     "direction of the rectangle's first side; its part along the normal is taken off",
     .required = true, .kinds = KIND(JOB_SECTION_RECTANGLE), AT(struct job_section, across)},
    {"size", SCHEMA_NUMBER, "sides of the rectangle, along `across` and at right angles to it",
     .unit = "m", .required = true, ABOVE_TO(0.0, FAR), .kinds = KIND(JOB_SECTION_RECTANGLE),
     AT(struct job_section, size)},
    {"by", SCHEMA_CHOICES, "what is counted apart as well: each material, each size class",
     .standard = "[]", .choices = splits, AT(struct job_section, by)},
    {"classes", SCHEMA_NUMBERS,
     "radii between the size classes, ascending; with `by: size` and none given, half way "
     "between the radii that groups and insertions name, at the radii of a `table`, and of "
     "another distribution seven between min and max in steps of one ratio, so that it has eight "
     "classes; at most 32 classes in all come so",
     .unit = "m", ABOVE_TO(0.0, FAR), GIVEN(struct job_section, classes),
     LIST_AT(struct job_section, classes, n_classes)},
    END};

#define BY_MATERIAL(type)                                                                      \
    {                                                                                          \
        "by", SCHEMA_CHOICES, "what is counted apart as well: each material",                  \
            .standard = "[]", .choices = materials_only, AT(type, by)                          \
    }

static const struct schema_key content_keys[] = {
    {"name", SCHEMA_NAME, "name of the content, used once", .required = true,
     AT(struct job_content, name)},
    {"region", SCHEMA_GROUP, "spheres count whose centre is in it", .required = true,
     REGION_AT(struct job_content, region, region.given)},
    {"follows", SCHEMA_NAME,
     "a rigid body that the region moves and turns with, from where it is at time 0; of a body that "
     "deforms, as the first of its sets that follows a `motion`; without it the region rests",
     GIVEN(struct job_content, follows), AT(struct job_content, follows)},
    BY_MATERIAL(struct job_content),
    END};

static const struct schema_key mix_keys[] = {
    {"material", SCHEMA_REFERENCE, "one of the materials", .required = true,
     AT(struct job_mix, material)},
    {"share", SCHEMA_NUMBER, "its share of the number, in parts of the sum of all", .unit = "1",
     .required = true, ABOVE_TO(0.0, 1e9), AT(struct job_mix, share)},
    END};

static const struct schema_key rate_keys[] = {
    {"number", SCHEMA_NUMBER, "spheres in a second", .unit = "1/s", ABOVE_TO(0.0, 1e12),
     GIVEN(struct job_insertion, by_number), AT(struct job_insertion, number_rate)},
    {"mass", SCHEMA_NUMBER, "mass in a second", .unit = "kg/s", ABOVE_TO(0.0, 1e12),
     GIVEN(struct job_insertion, by_mass), AT(struct job_insertion, mass_rate)},
    END};

static const struct schema_key until_keys[] = {
    {"count", SCHEMA_COUNT, "so many spheres have come in; 0: however many", .standard = "0",
     BETWEEN(0.0, 2e9), AT(struct job_insertion, until_count)},
    {"mass", SCHEMA_NUMBER, "the next sphere would bring more mass than this in all",
     .unit = "kg", .standard = "never", ABOVE(0.0), .word = "never", .word_value = INFINITY,
     AT(struct job_insertion, until_mass)},
    {"time", SCHEMA_NUMBER,
     "this instant: all that is due by then comes in by the step before it", .unit = "s",
     .standard = "never", ABOVE(0.0), .word = "never", .word_value = INFINITY,
     AT(struct job_insertion, until_time)},
    END};

static const struct schema_key insertion_keys[] = {
    {"name", SCHEMA_NAME, "name of the insertion, used once", .required = true,
     AT(struct job_insertion, name)},
    {"material", SCHEMA_REFERENCE, "what the spheres are made of, unless there is a mix",
     GIVEN(struct job_insertion, has_material), AT(struct job_insertion, material)},
    {"mix", SCHEMA_LIST, "several materials and their shares; each sphere's is drawn",
     UP_TO(1000.0), .inside = mix_keys, LIST_AT(struct job_insertion, mix, n_mix)},
    {"radius", SCHEMA_NUMBER, "radius of all of them", .unit = "m", ABOVE_TO(0.0, FAR),
     GIVEN(struct job_insertion, radius), AT(struct job_insertion, radius)},
    {"sizes", SCHEMA_GROUP, "radii that differ, instead of `radius`",
     SIZES_AT(struct job_insertion, sizes, sizes.given)},
    {"region", SCHEMA_GROUP,
     "where they appear: places are drawn evenly such that a sphere lies wholly within, touches "
     "nothing and is in no closed body, unless that holds most of the region",
     .required = true, REGION_AT(struct job_insertion, region, region.given)},
    {"velocity", SCHEMA_NUMBER, "velocity that they come with", .unit = "m/s", .standard = ZERO,
     BETWEEN(-FAR, FAR), AT(struct job_insertion, velocity)},
    {"velocity_spread", SCHEMA_NUMBER,
     "each velocity differs from `velocity` evenly by up to so much along x, y and z",
     .unit = "m/s", .standard = ZERO, BETWEEN(0.0, FAR), AT(struct job_insertion, spread)},
    {"spin", SCHEMA_NUMBER, "angular velocity that they come with", .unit = "rad/s",
     .standard = ZERO, BETWEEN(-FAR, FAR), AT(struct job_insertion, spin)},
    {"rate", SCHEMA_GROUP, "how much comes in, by number or by mass", .required = true,
     .inside = rate_keys},
    {"start", SCHEMA_NUMBER, "when it begins", .unit = "s", .standard = "0", BETWEEN(0.0, 1e9),
     AT(struct job_insertion, start)},
    {"until", SCHEMA_GROUP, "when it ends: with the first of these, or with the run",
     .inside = until_keys},
    {"every", SCHEMA_COUNT,
     "steps between occasions: what is due comes in at their multiples, and searches follow; the "
     "end of the run is none, as it can be put off: `until` its time, all comes in",
     .standard = "64", BETWEEN(1.0, 1e9), AT(struct job_insertion, every)},
    {"when_full", SCHEMA_CHOICE,
     "what happens when a sphere finds no room in 100 attempts: it waits for the next "
     "occasion, so the insertion falls behind and catches up; or the run stops",
     .standard = "wait", .choices = fulls, AT(struct job_insertion, full)},
    BY_MATERIAL(struct job_insertion),
    END};

static const struct schema_key removal_keys[] = {
    {"name", SCHEMA_NAME, "name of the removal, used once", .required = true,
     AT(struct job_removal, name)},
    {"region", SCHEMA_GROUP,
     "spheres whose centre comes into it, were it only to pass through, are taken out at the next "
     "multiple of 64 steps",
     .required = true, REGION_AT(struct job_removal, region, region.given)},
    {"start", SCHEMA_NUMBER, "when it begins", .unit = "s", .standard = "0", BETWEEN(0.0, 1e9),
     AT(struct job_removal, start)},
    {"stop", SCHEMA_NUMBER, "when it ends", .unit = "s", .standard = "never", AT_LEAST(0.0),
     .word = "never", .word_value = INFINITY, AT(struct job_removal, stop)},
    BY_MATERIAL(struct job_removal),
    END};

static const struct schema_key domain_keys[] = {
    {"min", SCHEMA_NUMBER,
     "least corner of the region that spheres may be in; by default the scene's extent, grown "
     "by its size",
     .unit = "m", BETWEEN(-10.0 * FAR, 10.0 * FAR), GIVEN(struct job, domain.given),
     AT(struct job, domain.min)},
    {"max", SCHEMA_NUMBER, "greatest corner of that region", .unit = "m",
     BETWEEN(-10.0 * FAR, 10.0 * FAR), GIVEN(struct job, domain.given),
     AT(struct job, domain.max)},
    {"periodic", SCHEMA_CHOICES,
     "directions along which the region repeats: what leaves on one side comes in on the other "
     "and touches across; needs min and max, at least 2.5 of the largest diameters apart; "
     "bodies are not repeated, let them reach past by a radius",
     .standard = "[]", .choices = directions, AT(struct job, domain.periodic)},
    {"leavers", SCHEMA_CHOICE,
     "what a sphere that leaves the region does: stop the run, get removed, or go on",
     .standard = "stop", .choices = leavers, AT(struct job, domain.leavers)},
    END};

static const struct schema_key decomposition_keys[] = {
    {"buffer", SCHEMA_NUMBER,
     "width of the buffer zone around a subdomain; larger means rarer redistribution and more "
     "copies; `auto` is half of the mean radius",
     .unit = "m", .standard = "auto", ABOVE_TO(0.0, FAR), .word = "auto", .word_value = 0.0,
     AT(struct job, decomposition.buffer)},
    {"imbalance", SCHEMA_NUMBER, "largest over mean run time of the ranks that moves the boxes",
     .unit = "1", .standard = "1.1", BETWEEN(1.0, 1e6),
     AT(struct job, decomposition.imbalance)},
    {"weights", SCHEMA_CHOICE,
     "what a sphere weighs besides itself: its contacts or its candidates",
     .standard = "contacts", .choices = weights, AT(struct job, decomposition.weights)},
    {"grid", SCHEMA_INT,
     "a fixed grid of equal subdomains along x, y and z, never rebalanced; their number must "
     "be that of the ranks",
     BETWEEN(1.0, 1000.0), GIVEN(struct job, decomposition.fixed),
     AT(struct job, decomposition.fixed)},
    END};

static const struct schema_key testing_keys[] = {
    {"search", SCHEMA_CHOICE, "how contacts are found", .standard = "auto", .choices = searches,
     AT(struct job, force.search)},
    {"search_every", SCHEMA_COUNT, "force a search every so many steps; 0: only when due",
     .standard = "0", BETWEEN(0.0, 1e15), AT(struct job, force.search_every)},
    {"redistribute_every", SCHEMA_COUNT,
     "force the high level of redistribution likewise; 0: when due", .standard = "0",
     BETWEEN(0.0, 1e15), AT(struct job, force.redistribute_every)},
    {"repartition_every", SCHEMA_COUNT, "force the low level likewise; 0: when due",
     .standard = "0", BETWEEN(0.0, 1e15), AT(struct job, force.repartition_every)},
    END};

static const struct schema_key every_keys[] = {
    {"wall", SCHEMA_NUMBER, "wall-clock time between checkpoints; 0: not by the clock",
     .unit = "s", .standard = "600", BETWEEN(0.0, 1e9), AT(struct job, checkpoint.every_wall)},
    {"steps", SCHEMA_COUNT, "steps between checkpoints; 0: not by steps", .standard = "0",
     BETWEEN(0.0, 1e15), AT(struct job, checkpoint.every_steps)},
    {"time", SCHEMA_NUMBER,
     "simulated time between checkpoints, rounded to whole steps (at least one); 0: not by it",
     .unit = "s", .standard = "0", BETWEEN(0.0, 1e9), AT(struct job, checkpoint.every_time)},
    {"mtbf", SCHEMA_NUMBER,
     "mean time between failures of the machine, or between preemptions: the wall-clock time "
     "between checkpoints is then sqrt(2 C mtbf) instead of `wall`, where C is what one takes "
     "(Young 1974, Daly 2006); 0: as `wall` says",
     .unit = "s", .standard = "0", BETWEEN(0.0, 1e12), AT(struct job, checkpoint.mtbf)},
    END};

static const struct schema_key checkpoint_keys[] = {
    {"every", SCHEMA_GROUP, "when a checkpoint is due; one is always written at the end",
     .inside = every_keys},
    {"keep", SCHEMA_INT, "how many of the newest are kept", .standard = "3", BETWEEN(1.0, 1e6),
     AT(struct job, checkpoint.keep)},
    END};

static const struct schema_key series_keys[] = {
    {"every", SCHEMA_NUMBER,
     "simulated time between records, rounded to whole steps (at least one)", .unit = "s",
     .standard = "0.01", ABOVE_TO(0.0, 1e9), AT(struct job, output.series_every)},
    END};

static const struct schema_key snapshots_keys[] = {
    {"every", SCHEMA_NUMBER,
     "simulated time between snapshots, rounded to whole steps (at least one)", .unit = "s",
     .required = true, ABOVE_TO(0.0, 1e9), AT(struct job, output.snapshots.every)},
    {"fields", SCHEMA_CHOICES, "what is kept of each sphere besides id, position and radius",
     .standard = "[velocity, angular_velocity, force, material, group]",
     .choices = snapshot_fields, AT(struct job, output.snapshots.fields)},
    {"contacts", SCHEMA_FLAG, "place and force of each contact between spheres as well",
     .standard = "false", AT(struct job, output.snapshots.contacts)},
    {"solids", SCHEMA_CHOICES,
     "what is kept of each deformable body besides its places; of nodes: displacement, velocity, "
     "contact_force and contact_pressure, of that instant; of elements: the others, of shells and "
     "membranes alone their thickness",
     .standard = "[displacement, velocity, contact_force, contact_pressure, stress, von_mises, "
                 "principal_stress, plastic_strain, thickness, alive]",
     .choices = solid_fields, AT(struct job, output.snapshots.solids)},
    {"compress", SCHEMA_CHOICE,
     "whether numbers are packed, which loses nothing, takes about half the space and several "
     "times as long to write",
     .standard = "none", .choices = compressions, AT(struct job, output.snapshots.compress)},
    {"precision", SCHEMA_CHOICE,
     "numbers of spheres, contacts and deformable bodies as they are, or rounded to 7 digits in half the space",
     .standard = "double", .choices = precisions, AT(struct job, output.snapshots.precision)},
    END};

static const struct schema_key probe_keys[] = {
    {"name", SCHEMA_NAME, "name of the probe, used once", .required = true,
     AT(struct job_probe, name)},
    {"body", SCHEMA_NAME, "a body that deforms", .required = true, AT(struct job_probe, body)},
    {"node", SCHEMA_NUMBER,
     "its displacement and velocity: of the node that at the start is nearest to this point; a "
     "probe has one of node, nodes, element, elements",
     .unit = "m", BETWEEN(-FAR, FAR), GIVEN(struct job_probe, has_node),
     AT(struct job_probe, node)},
    {"nodes", SCHEMA_TEXT, "their means over the nodes of this set of the body",
     GIVEN(struct job_probe, nodes), AT(struct job_probe, nodes)},
    {"element", SCHEMA_NUMBER,
     "its stress, von Mises's stress and plastic strain: of the element whose middle is nearest to "
     "this point at the start",
     .unit = "m", BETWEEN(-FAR, FAR), GIVEN(struct job_probe, has_element),
     AT(struct job_probe, element)},
    {"elements", SCHEMA_TEXT,
     "their means, weighted by mass, and the greatest of the last two, over the elements of this "
     "set of the body",
     GIVEN(struct job_probe, elements), AT(struct job_probe, elements)},
    END};

static const struct schema_key output_keys[] = {
    {"series", SCHEMA_GROUP, "energies, forces on bodies, passages through sections over time",
     .inside = series_keys},
    {"snapshots", SCHEMA_GROUP,
     "spheres and bodies at regular times in RUN/snapshots/, for ParaView and other tools; none "
     "when left out",
     .inside = snapshots_keys, GIVEN(struct job, output.snapshots.every)},
    {"probes", SCHEMA_LIST, "nodes and elements of deformable bodies that the series follow",
     UP_TO(1000.0), .inside = probe_keys, GIVEN(struct job, output.n_probes),
     LIST_AT(struct job, output.probes, output.n_probes)},
    END};

static const struct schema_key watch_keys[] = {
    {"overlap", SCHEMA_NUMBER, "largest overlap over radius that a run goes on with",
     .unit = "1", .standard = "0.1", ABOVE_TO(0.0, 1.0), AT(struct job, watch.overlap)},
    {"motion", SCHEMA_NUMBER, "largest motion in one step over radius", .unit = "1",
     .standard = "0.1", ABOVE_TO(0.0, 1.0), AT(struct job, watch.motion)},
    {"step", SCHEMA_NUMBER,
     "largest time step over the critical step of the present contacts; that is a bound, which "
     "dense beds bear to exceed by a tenth to a quarter, with strong damping or rolling friction "
     "by half and more",
     .unit = "1", .standard = "1", ABOVE_TO(0.0, 1e3), AT(struct job, watch.step)},
    {"energy", SCHEMA_NUMBER,
     "largest error of the energy balance over the energy turned over, with contact.ledger; 0: "
     "not watched",
     .unit = "1", .standard = "0.1", BETWEEN(0.0, 1e6), AT(struct job, watch.energy)},
    {"hourglass", SCHEMA_NUMBER,
     "largest share of a solid's internal energy in hourglass modes, with contact.ledger; 0: not "
     "watched",
     .unit = "1", .standard = "0.1", BETWEEN(0.0, 1e6), AT(struct job, watch.hourglass)},
    END};

#define SWEEP_KEYS                                                                             \
    {"key", SCHEMA_TEXT, "the key that varies, as for --set: `spheres.0.radius`",              \
     AT(struct sweep_item, key)},                                                              \
        {"name", SCHEMA_NAME,                                                                  \
         "what it is called in folders and tables; by default the last word of `key`",         \
         AT(struct sweep_item, name)},                                                         \
        {"values", SCHEMA_ELSEWHERE, "its values, whatever the key takes",                     \
         .word = "a list of values"},                                                          \
        {"from", SCHEMA_TEXT,                                                                  \
         "or its first value of `count`, a number with or without a unit",                     \
         AT(struct sweep_item, from)},                                                         \
        {"to", SCHEMA_TEXT, "the last one, in the same unit", AT(struct sweep_item, to)},      \
        {"count", SCHEMA_INT, "how many", BETWEEN(2.0, SWEEP_MOST),                            \
         AT(struct sweep_item, count)},                                                        \
    {                                                                                          \
        "spacing", SCHEMA_CHOICE,                                                              \
            "equal steps or equal ratios between them; values are rounded to 12 digits",       \
            .standard = "linear", .choices = spacings, AT(struct sweep_item, spacing)          \
    }

static const struct schema_key together_keys[] = {SWEEP_KEYS, END};

const struct schema_key job_keys_sweep[] = {
    SWEEP_KEYS,
    {"together", SCHEMA_LIST,
     "instead of `key`: keys that vary together, each with as many values as the others",
     UP_TO(100.0), .inside = together_keys, LIST_AT(struct sweep_item, together, n_together)},
    END};

const struct schema_key job_keys[] = {
    {"title", SCHEMA_TEXT, "what people call the job", .standard = "", AT(struct job, title)},
    {"dimension", SCHEMA_CHOICE, "spheres move in three dimensions", .standard = "3",
     .choices = dimensions},
    {"include", SCHEMA_ELSEWHERE,
     .help =
         "libraries of materials and pairs, relative to the job file; what the job says wins, "
         "then what a later library says",
     .word = "the path of a file, or a list of them,"},
    {"time", SCHEMA_GROUP, "how long and in which steps", .required = true,
     .inside = time_keys},
    {"start", SCHEMA_GROUP,
     "spheres that another job has left, with what their contacts remember (of those with "
     "bodies: with such as are the same and at rest in both jobs); time begins at 0",
     .inside = start_keys, GIVEN(struct job, start.given)},
    {"seed", SCHEMA_COUNT,
     "seed of all random numbers: another one gives another scene that is as likely",
     .standard = "1", BETWEEN(0.0, 1e15), AT(struct job, seed)},
    {"gravity", SCHEMA_NUMBER, "acceleration of gravity", .unit = "m/s2",
     .standard = "[0, 0, -9.81]", BETWEEN(-FAR, FAR), AT(struct job, gravity)},
    {"gravity_turn", SCHEMA_GROUP, "turns gravity, as a tilted or rocking frame feels it",
     .inside = gravity_turn_keys, GIVEN(struct job, gravity_turn.axis)},
    {"gravity_table", SCHEMA_LIST, "gravity over time; `gravity` is then not used",
     BETWEEN(1.0, 10000.0), GIVEN(struct job, n_gravity_table), .inside = gravity_table_keys,
     LIST_AT(struct job, gravity_table, n_gravity_table)},
    {"damping", SCHEMA_NUMBER,
     "mass-proportional damping: a force of -damping x mass x velocity on every sphere, and "
     "a moment likewise",
     .unit = "1/s", .standard = "0", BETWEEN(0.0, 1e9), AT(struct job, damping)},
    {"damping_regions", SCHEMA_LIST, "parts of space with damping of their own", UP_TO(100.0),
     .inside = damping_region_keys, GIVEN(struct job, n_damping_regions),
     LIST_AT(struct job, damping_regions, n_damping_regions)},
    {"materials", SCHEMA_NAMED, "materials by name; those that nothing uses are left out",
     .required = true, UP_TO(1000.0), .inside = material_keys,
     LIST_AT(struct job, materials, n_materials)},
    {"contact", SCHEMA_GROUP, "what happens between materials", .inside = contact_keys},
    {"spheres", SCHEMA_LIST,
     "groups of spheres that are there at the start; ids run through them in this order",
     UP_TO(10000.0), .inside = spheres_keys, LIST_AT(struct job, spheres, n_spheres)},
    {"insert", SCHEMA_LIST,
     "spheres that come in while the run goes on; their groups are counted on from those of "
     "`spheres`",
     UP_TO(1000.0), .inside = insertion_keys, LIST_AT(struct job, insertions, n_insertions)},
    {"remove", SCHEMA_LIST,
     "regions that take spheres out of the run; where they overlap the first one counts",
     UP_TO(1000.0), .inside = removal_keys, LIST_AT(struct job, removals, n_removals)},
    {"bodies", SCHEMA_LIST,
     "surfaces of quads and triangles: at rest, moving as prescribed or moved by forces; or "
     "deformable solids of finite elements",
     UP_TO(10000.0), .inside = body_keys, LIST_AT(struct job, bodies, n_bodies)},
    {"sections", SCHEMA_LIST,
     "planes, discs and rectangles that count what passes through them", UP_TO(60.0),
     .inside = section_keys, LIST_AT(struct job, sections, n_sections)},
    {"contents", SCHEMA_LIST,
     "regions whose content is recorded: number, mass and mean velocity of the spheres in them",
     UP_TO(1000.0), .inside = content_keys, LIST_AT(struct job, contents, n_contents)},
    {"domain", SCHEMA_GROUP, "the region that spheres may be in", .inside = domain_keys},
    {"decomposition", SCHEMA_GROUP, "how the work is shared among ranks; changes no result",
     .inside = decomposition_keys},
    {"checkpoint", SCHEMA_GROUP, "states on disk from which a run resumes",
     .inside = checkpoint_keys},
    {"output", SCHEMA_GROUP, "what is recorded", .inside = output_keys},
    {"watch", SCHEMA_GROUP, "limits that stop a run, with the last good checkpoint kept",
     .inside = watch_keys},
    {"order_every", SCHEMA_COUNT,
     "steps between renewals of the canonical order of the spheres; part of the result's last "
     "bits",
     .standard = "4096", BETWEEN(1.0, 1e9), AT(struct job, order_every)},
    {"testing", SCHEMA_GROUP, "for tests of reproducibility; changes no result",
     .inside = testing_keys},
    {"sweep", SCHEMA_ELSEWHERE,
     "a study: a run for every combination of the values of these keys, of the first the slowest; "
     "an empty list is none",
     .word = "a list of mappings (- key: value)", .inside = job_keys_sweep},
    END};
