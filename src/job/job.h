/*
 * What the user asked for: a job file, read, checked and completed with defaults.
 *
 * The schema table (job/schema) is the one description of every key; this struct is what it
 * fills.  Everything is in SI units here.  Indices refer to the arrays of this struct.
 */
#ifndef TREMIE_JOB_JOB_H
#define TREMIE_JOB_JOB_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec3.h"

struct mistakes;
struct sweep;

/* Where an item begins in the job file, for messages; 0: not there.  Not a key. */
struct job_place {
    int line, column;
};

/* A point of a hardening curve: the stress at which metal yields that has flowed so far. */
struct job_hardening {
    double strain; /* plastic, equivalent [-] */
    double stress; /* [Pa] */
};

struct job_material {
    char *name;
    double density; /* [kg/m3] */
    double young;   /* [Pa] */
    double poisson; /* [-] */
    /* Of solids: elastic where neither yield nor a table is given. */
    double yield;     /* stress [Pa]; 0: none given */
    double hardening; /* stress over plastic strain, beyond yield [Pa]; 0: perfectly plastic */
    int n_hardening_table; /* in place of both */
    struct job_hardening *hardening_table;
};

enum job_law { JOB_LAW_HERTZ, JOB_LAW_LINEAR, JOB_LAW_DEFAULT /* that of the job */ };
enum job_rolling { JOB_ROLLING_SPRING, JOB_ROLLING_CONSTANT };

/* Contact between two materials; a <= b.  Every pair that can meet has one. */
struct job_pair {
    int a, b;
    double friction;        /* Coulomb coefficient [-] */
    double static_friction; /* [-]; negative: the same */
    double restitution;     /* [-], what comes out, whatever the law */
    enum job_law law;
    double stiffness;        /* linear: normal [N/m]; 0: that of the job */
    double tangential_ratio; /* linear: tangential over normal stiffness [-] */
    enum job_rolling rolling;
    double rolling_friction;  /* [-] */
    double twisting_friction; /* [-] */
};

enum job_region_kind {
    JOB_REGION_BOX,
    JOB_REGION_CYLINDER,
    JOB_REGION_SPHERE,
    JOB_REGION_INSIDE
};

/* A part of space, at rest. */
struct job_region {
    bool given;
    enum job_region_kind kind;
    struct vec3 min, max; /* box [m] */
    struct vec3 from, to; /* cylinder: the ends of its axis [m] */
    struct vec3 centre;   /* sphere [m] */
    double radius;        /* cylinder, sphere [m] */
    char *body;           /* inside: of this body's closed surface, as it is at time 0 */
};

enum job_sizes_kind {
    JOB_SIZES_LIST,
    JOB_SIZES_UNIFORM,
    JOB_SIZES_NORMAL,
    JOB_SIZES_LOGNORMAL,
    JOB_SIZES_TABLE
};
enum job_sizes_by { JOB_SIZES_BY_NUMBER, JOB_SIZES_BY_MASS };

struct job_size {
    double radius; /* [m] */
    double share;  /* list: of this radius; table: of all radii up to this one */
};

/* A distribution of radii (THEORY.md, Sizes). */
struct job_sizes {
    bool given;
    enum job_sizes_kind kind;
    enum job_sizes_by by;   /* what the shares are shares of */
    double min, max;        /* uniform, normal, lognormal: cut off there [m] */
    double mean, deviation; /* normal, lognormal: before they are cut off [m] */
    int n;
    struct job_size *list; /* list, table */
};

enum job_packing {
    JOB_PACKING_LATTICE,
    JOB_PACKING_HEXAGONAL,
    JOB_PACKING_RANDOM,
    JOB_PACKING_CSV,
    JOB_PACKING_HDF5
};

/* A group of spheres.  Ids run through the groups in the order of the file. */
struct job_spheres {
    char *name;
    int material;
    double radius; /* [m]; for CSV without a radius column; 0 with sizes */
    struct job_sizes sizes;
    struct vec3 velocity; /* initial [m/s] */
    struct vec3 spin;     /* initial angular velocity [rad/s] */
    enum job_packing packing;
    /* Lattice: `count` places in rows along x, then y, then layers along z, `spacing` apart;
     * a layer covers size[0] x size[1] from the corner (the least coordinates of sphere
     * *surfaces*). */
    int64_t count;
    double spacing; /* [m] */
    struct vec3 corner;
    double size[2]; /* [m] */
    /* Random: so many, or as many as make up a mass or a share of the region's volume; 0: not
     * given. */
    double mass;     /* [kg] */
    double fraction; /* [-] */
    struct job_region region;
    double gap;       /* least distance between surfaces [m] */
    int64_t attempts; /* places tried for one sphere */
    bool avoid_bodies;
    /* CSV with a header line that names columns: x_m,y_m,z_m and optionally radius_m, material,
     * vx_m_s,vy_m_s,vz_m_s (resolved relative to the job file).  HDF5 with /spheres/position,
     * radius and, where given, velocity, angular_velocity. */
    char *file;
    int64_t sum; /* checksum of that file */
    struct job_place place;
};

enum job_velocities { JOB_VELOCITIES_KEEP, JOB_VELOCITIES_ZERO };

/* A group of the job that another one starts from, which it has not itself. */
struct job_start_group {
    char *name;
};

enum job_geometry {
    JOB_GEOMETRY_PLANE,
    JOB_GEOMETRY_BOX,
    JOB_GEOMETRY_HOPPER,
    JOB_GEOMETRY_MESH,
    JOB_GEOMETRY_CYLINDER,
    JOB_GEOMETRY_CONE,
    JOB_GEOMETRY_CONICAL_HOPPER,
    JOB_GEOMETRY_TUBE,
    JOB_GEOMETRY_STL,
    JOB_GEOMETRY_GMSH
};

enum job_cap { JOB_CAP_FROM = 1, JOB_CAP_TO = 2 }; /* closed ends */

enum job_side { /* sides of a box that are left open */
                JOB_SIDE_X_MIN = 1,
                JOB_SIDE_X_MAX = 2,
                JOB_SIDE_Y_MIN = 4,
                JOB_SIDE_Y_MAX = 8,
                JOB_SIDE_BOTTOM = 16,
                JOB_SIDE_TOP = 32,
};

/* A place of a tabulated path. */
struct job_path_point {
    double time;       /* since the motion's start [s] */
    struct vec3 place; /* [m]; differences from the first one count */
    double angle;      /* about the path's axis [rad]; likewise */
};

/* One motion, while it lasts: X -> pivot + Q(angle) (X - pivot) + shift, where the shift is
 * that of velocity, oscillation and path together and the angle that of one of rotation, swing
 * and path (THEORY.md, section 3). */
struct job_motion {
    struct vec3 velocity;    /* [m/s] */
    struct vec3 pivot, axis; /* axis has length 1, or 0 where nothing rotates */
    double rate;             /* angular velocity about the axis [rad/s] */
    struct {                 /* there when direction has length 1 */
        struct vec3 direction;
        double amplitude;        /* [m] */
        double frequency, phase; /* [1/s], [rad] */
    } oscillation;
    struct { /* there when axis has length 1 */
        struct vec3 pivot, axis;
        double amplitude;        /* [rad] */
        double frequency, phase; /* [1/s], [rad] */
    } swing;
    struct {
        bool given;
        char *file; /* of the job file alone: read into points, then NULL */
        int n;
        struct job_path_point *points;
        struct vec3 pivot, axis; /* axis has length 0 where the path does not turn */
    } path;
    double start, stop; /* [s]; stop is infinite by default */
};

enum job_drive { JOB_DRIVE_SLIDE, JOB_DRIVE_TURN };

/* One freedom of a body, along or about an axis, that forces move. */
struct job_driven {
    bool given;
    enum job_drive kind;
    struct vec3 axis;      /* of length 1 */
    struct vec3 point;     /* turn: of the axis [m] */
    double mass, inertia;  /* slide [kg]; turn, about the axis [kg m2] */
    double force, torque;  /* applied, along or about the axis [N], [N m] */
    double speed, rate;    /* at the start [m/s], [rad/s] */
    double damping;        /* force = -damping * mass * speed, torque likewise [1/s] */
    double friction, drag; /* slide [N], turn [N m]: what dry friction can hold */
    bool limited;
    double travel[2], angles[2]; /* least and greatest [m], [rad]; 0 at the start */
    double start;                /* held until then [s] */
};

/* All six freedoms of a body. */
struct job_free {
    bool given;
    double mass;    /* [kg]; 0: from the density */
    double density; /* of the closed surface's inside [kg/m3] */
    bool has_inertia, has_centre;
    double inertia[6];          /* about the centre: xx, yy, zz, xy, xz, yz [kg m2] */
    struct vec3 centre;         /* of mass, at the start [m] */
    struct vec3 velocity, spin; /* at the start [m/s], [rad/s] */
    double damping;             /* [1/s] */
    double start;               /* held until then [s] */
};

enum { JOB_FORCED_MOST = 300 }; /* bodies that forces move, in one job */

enum job_mesh_kind {
    JOB_MESH_BOX,
    JOB_MESH_PLATE,
    JOB_MESH_CYLINDER,
    JOB_MESH_TUBE,
    JOB_MESH_GMSH
};
enum job_elements { JOB_ELEMENTS_HEXAHEDRA, JOB_ELEMENTS_TETRAHEDRA };
enum job_hourglass { JOB_HOURGLASS_STIFFNESS, JOB_HOURGLASS_VISCOUS };

/* What the nodes of a solid touch. */
enum job_touches { JOB_TOUCHES_SPHERES, JOB_TOUCHES_BODIES, JOB_TOUCHES_ITSELF };

/* A part of a solid: its nodes in a region. */
struct job_set {
    char *name;
    struct job_region region;
    struct job_place place;
};

/* A value at a time, between which it changes linearly. */
struct job_value {
    double time; /* [s] */
    double value;
};

/* How thick a part of a shell or membrane is. */
struct job_thickness {
    char *set;
    double thickness; /* [m] */
    struct job_place place;
};

/* What the nodes of a set bear besides the mass of their elements. */
struct job_mass {
    char *set;
    double mass, inertia; /* of all of them together [kg], [kg m2] */
    struct job_place place;
};

/* Shells or membranes on a set of a solid. */
struct job_shell {
    char *set;
    double thickness; /* [m] */
    enum { JOB_SHELL_BENDS, JOB_SHELL_MEMBRANE } model;
    bool has_material; /* else the body's */
    int material;
    struct job_place place;
};

/* What is prescribed on a set of a body that deforms; one of these (model/solid_condition). */
struct job_boundary {
    char *set;
    int fixed;       /* directions in which nodes stay, a set of enum job_direction */
    int fixed_turns; /* axes about which they do not turn, likewise */
    int n_motions;   /* which they follow, one after the other */
    struct job_motion *motions;
    bool has_direction, has_velocity, has_force, has_pressure;
    int direction;                     /* 0 x, 1 y, 2 z: of displacement, velocity, force */
    double velocity, force, pressure;  /* [m/s], [N] in all, [Pa] against the surface */
    int n_displacements, n_velocities; /* or such a table */
    int n_forces, n_pressures;
    struct job_value *displacements, *velocities, *forces, *pressures;
    struct job_place place;
};

enum { JOB_VOLUME_NAME = 128 }; /* bytes of a group's name */

/* A physical group of a file: items first .. first + n - 1. */
struct job_volume_group {
    char name[JOB_VOLUME_NAME]; /* its number where it has none */
    int dimension;              /* of points, curves, surfaces, volumes: 0 to 3 */
    int first, n;
};

/* The solid that a file holds (store/surface_file); not a key. */
struct job_volume {
    int n_nodes, n_elements, n_groups, n_items;
    struct vec3 *nodes; /* [unit of the file] */
    int (*elements)[8]; /* nodes as in model/solid_mesh.h; of a tetrahedron the fifth is -1 */
    int64_t *node_numbers, *element_numbers; /* in the file */
    struct job_volume_group *groups;
    int (
        *items)[4]; /* nodes of a point, line, triangle or quad, else -1; or an element first */
};

struct solid_mesh;

/* What a deformable body has that a rigid one has not. */
struct job_solid {
    enum job_mesh_kind kind;
    enum job_elements elements;
    int cells[3];         /* 0: as `size` says */
    double cell;          /* wanted width of a cell [m]; 0: as `cells` says */
    struct vec3 corner;   /* plate: least corner */
    double size[2];       /* plate: along x and y [m] */
    double thickness;     /* plate: along z [m] */
    struct vec3 velocity; /* at the start [m/s] */
    struct {
        double mass, stiffness; /* Rayleigh's [1/s], [s] */
    } damping;
    struct {
        enum job_hourglass kind;
        double coefficient; /* [-] */
    } hourglass;
    struct {
        enum job_touches what;
        double stiffness; /* of a node's spring, over what it is made of [-] */
    } touches;
    int n_sets, n_boundary, n_thicknesses, n_shells, n_masses;
    struct job_set *sets;
    struct job_thickness *thicknesses; /* of parts of shells and membranes */
    struct job_shell *shells;          /* of a solid */
    struct job_mass *masses;
    struct job_boundary *boundary;
    struct job_volume volume; /* Gmsh, once it has been read */
    struct solid_mesh *mesh;  /* kept by model/solid_mesh, which frees it; not a key */
};

enum job_model { JOB_MODEL_RIGID, JOB_MODEL_SOLID, JOB_MODEL_SHELL, JOB_MODEL_MEMBRANE };

/* A rigid body: a surface of quads and triangles, at rest, moved as prescribed or by forces.
 * Or a shell or membrane of such a surface. Or a solid, whose mesh takes min, max, from, to,
 * radii, file, group, scale, rotation and shift from here too. */
struct job_body {
    char *name;
    int material;
    enum job_model model;
    struct job_solid solid;
    struct {              /* shell, membrane */
        double thickness; /* [m]; of a rigid body for advice alone, 0: not given */
        double cell;      /* wanted width of an element [m]; 0: a facet is one */
        int layers;       /* points through the thickness of a shell; of a solid's too */
    } sheet;
    struct job_place place;
    enum job_geometry geometry;
    struct vec3 point, normal; /* plane: a square facet through `point`, facing `normal` */
    double extent;             /* plane: edge of the square [m] */
    struct vec3 min, max;      /* box */
    int open;                  /* box: sides left open, a set of enum job_side */
    double top[2], outlet[2];  /* hopper: openings, width along x and y [m] */
    double z[2];               /* hoppers: heights of outlet and top [m] */
    double centre[2];          /* hoppers: axis, x and y [m] */
    struct vec3 from, to;      /* cylinder, cone, tube: ends of the axis [m] */
    double radius;             /* cylinder [m] */
    double radii[2];           /* cone: at from and to; conical hopper: outlet, top [m] */
    double inner, outer;       /* tube: radii [m] */
    int caps;                  /* cylinder, cone: closed ends, a set of enum job_cap */
    int segments;              /* facets around the axis; 0: the curved surface itself */
    char *file;                /* STL, Gmsh */
    int64_t sum;               /* checksum of that file */
    char *group;               /* Gmsh: physical group; NULL: all surfaces */
    double merge;              /* mesh and files: vertices nearer than this are one [m] */
    int n_vertices;            /* mesh; of a file once it has been read (store/surface_file) */
    struct vec3 *vertices;     /* [m] */
    int n_facets;
    int (*facets)[4]; /* vertex indices; a triangle has -1 last */
    /* Then any shape is scaled about the origin (0: not), rotated by an angle about an axis
     * through a point (axis 0: not), and moved. */
    double scale;
    struct vec3 turn_axis, turn_point;
    double turn_angle; /* [rad] */
    struct vec3 move;  /* [m] */
    /* Prescribed motion: each motion moves what those before it in the list have made of the
     * body. */
    int n_motions;
    struct job_motion *motions;
    struct job_driven driven;
    struct job_free free;
    struct { /* the surface runs while the body stays: translation and rotation alone */
        bool given;
        struct job_motion motion;
    } surface;
    bool comes_and_goes;
    double active[2]; /* then: when it comes and when it goes [s] */
};

/* Has it nodes that turn? */
static inline bool job_turns(const struct job_body *body)
{
    bool turns = body->model == JOB_MODEL_SHELL;
    for (int k = 0; k < body->solid.n_shells; k++)
        turns = turns || body->solid.shells[k].model == JOB_SHELL_BENDS;
    return turns;
}

/* Is it made of finite elements? */
static inline bool job_deforms(const struct job_body *body)
{
    return body->model != JOB_MODEL_RIGID;
}

/* Does an item of a boundary hold or move nodes, not push them? */
static inline bool job_boundary_holds(const struct job_boundary *asked)
{
    return asked->fixed != 0 || asked->n_motions > 0 || asked->n_displacements > 0 ||
           asked->has_velocity || asked->n_velocities > 0;
}

/* A part of space with damping of its own, besides the job's. */
struct job_damping_region {
    struct job_region region;
    double damping; /* [1/s] */
};

/* Gravity at a time, between which it changes linearly. */
struct job_gravity {
    double time;         /* [s] */
    struct vec3 gravity; /* [m/s2] */
};

enum job_split { /* what counts are told apart by besides the total */
                 JOB_SPLIT_MATERIAL = 1,
                 JOB_SPLIT_SIZE = 2,
};

enum job_section_kind { JOB_SECTION_PLANE, JOB_SECTION_DISC, JOB_SECTION_RECTANGLE };

/* A plane, or a part of one, that counts what passes; forward is along the normal. */
struct job_section {
    char *name;
    enum job_section_kind kind;
    struct vec3 point, normal; /* the centre of a disc or rectangle; the normal has length 1 */
    double radius;             /* disc [m] */
    struct vec3 across;        /* rectangle: along its first side, has length 1 */
    double size[2];            /* rectangle: along `across` and along normal x across [m] */
    int by;                    /* set of enum job_split */
    int n_classes;
    double *classes; /* radii between size classes, ascending [m] */
};

/* A region whose content is reported. */
struct job_content {
    char *name;
    struct job_region region;
    char *follows; /* NULL: none; the body that the region moves with */
    int by;        /* set of enum job_split */
};

/* Where the series follow a deformable body; one of the four says where. */
struct job_probe {
    char *name;
    char *body;
    bool has_node, has_element;
    struct vec3 node, element; /* the node, or middle of an element, nearest to it [m] */
    char *nodes, *elements;    /* those of a set */
    struct job_place place;
};

/* A region out of which spheres are taken whose centre is in it. */
struct job_removal {
    char *name;
    struct job_region region;
    double start, stop; /* [s] */
    int by;             /* set of enum job_split */
};

struct job_mix {
    int material;
    double share; /* of the number, in parts of the sum of all */
};

enum job_full { JOB_FULL_WAIT, JOB_FULL_STOP };

/* Spheres that come in while the run goes on. */
struct job_insertion {
    char *name;
    bool has_material;
    int material; /* where there is no mix */
    int n_mix;
    struct job_mix *mix;
    double radius; /* [m]; 0 with sizes */
    struct job_sizes sizes;
    struct job_region region; /* holds the spheres wholly */
    struct vec3 velocity;     /* [m/s] */
    struct vec3 spread;       /* of the velocity: evenly up to so much more or less [m/s] */
    struct vec3 spin;         /* [rad/s] */
    bool by_number, by_mass;  /* one of them */
    double number_rate;       /* [1/s] */
    double mass_rate;         /* [kg/s] */
    double start;             /* [s] */
    int64_t every;            /* steps between occasions */
    int64_t until_count;      /* 0: no limit */
    double until_mass;        /* [kg] */
    double until_time;        /* [s] */
    enum job_full full;
    int by; /* set of enum job_split */
    struct job_place place;
};

enum job_direction { JOB_DIRECTION_X = 1, JOB_DIRECTION_Y = 2, JOB_DIRECTION_Z = 4 };
enum job_leavers { JOB_LEAVERS_STOP, JOB_LEAVERS_REMOVE, JOB_LEAVERS_IGNORE };
enum job_weights { JOB_WEIGHTS_CONTACTS, JOB_WEIGHTS_CANDIDATES };
enum job_compress { JOB_COMPRESS_NONE, JOB_COMPRESS_LOSSLESS };
enum job_precision { JOB_PRECISION_DOUBLE, JOB_PRECISION_SINGLE };
enum job_search { JOB_SEARCH_AUTO, JOB_SEARCH_ALL_PAIRS };

struct job {
    char *path; /* the job file */
    char *name; /* its file name without folder and ending: names the run folder */
    char *title;
    struct {
        double end;    /* [s]; a whole number of steps */
        double step;   /* [s]; 0 means auto */
        double safety; /* step: auto takes this share of the critical step */
        int substeps;  /* of finite elements in one step */
    } time;
    struct {
        bool given;
        char *from;       /* folder of a run, or a checkpoint */
        char *checkpoint; /* name of the file in that folder; NULL: the newest */
        int64_t sum;      /* checksum of the checkpoint; 0: whatever it has */
        enum job_velocities velocities;
        int n_groups;
        struct job_start_group *groups; /* that come with its spheres */
        bool recalled;                  /* not a key: the run that is resumed has it already */
    } start;
    int64_t seed;        /* of all random numbers */
    struct vec3 gravity; /* [m/s2]; at the start where it turns, none where there is a table */
    struct {
        struct vec3 axis; /* of length 1; 0: it does not turn */
        double rate;      /* [rad/s] */
        double start, stop;
    } gravity_turn;
    int n_gravity_table;
    struct job_gravity *gravity_table;
    int n_damping_regions;
    struct job_damping_region *damping_regions;
    double damping; /* mass-proportional: force = -damping * m * v [1/s] */
    int n_materials, n_pairs, n_spheres, n_bodies, n_sections;
    int n_contents, n_insertions, n_removals;
    struct job_material *materials;
    struct job_pair *pairs;
    struct job_spheres *spheres;
    struct job_body *bodies;
    struct job_section *sections; /* at most 60 */
    struct job_content *contents;
    struct job_insertion *insertions;
    struct job_removal *removals;
    enum job_law law;   /* of pairs that say nothing else */
    double stiffness;   /* linear: normal, of such pairs [N/m]; 0: none given */
    bool energy_ledger; /* contact.ledger: on by default */
    struct {
        bool given;           /* else: the extent of the scene, grown by its size */
        struct vec3 min, max; /* [m] */
        int periodic;         /* directions that repeat, a set of enum job_direction */
        enum job_leavers leavers;
    } domain;
    struct {
        double buffer; /* width of the buffer zone [m]; 0 means auto (half the mean radius) */
        double imbalance; /* largest over mean time that repartitions */
        enum job_weights weights;
        int fixed[3]; /* a fixed grid of subdomains, {0, 0, 0} when balanced */
    } decomposition;
    struct { /* for tests of the bits: none of these may change a result */
        enum job_search search;
        int64_t search_every;       /* steps; 0: only when due */
        int64_t redistribute_every; /* high level forced every so many steps; 0: never */
        int64_t repartition_every;  /* low level forced likewise */
    } force;
    struct {
        double every_wall;   /* [s]; 0: never */
        int64_t every_steps; /* 0: never */
        double every_time;   /* simulated [s]; 0: never */
        double mtbf;         /* mean time between failures [s]; 0: unknown */
        int keep;
    } checkpoint;
    struct {
        double series_every; /* [s]; a whole number of steps */
        struct {
            double every; /* [s]; a whole number of steps; 0: no snapshots */
            int fields;   /* bit k: enum snapshot_field SNAPSHOT_FIRST_CHOICE + k */
            bool contacts;
            int solids; /* bits likewise: of enum snapshot_node_field, then of elements' */
            enum job_compress compress;
            enum job_precision precision;
        } snapshots;
        int n_probes;
        struct job_probe *probes;
    } output;
    struct {
        double overlap; /* largest overlap over radius that a run tolerates [-] */
        double motion;  /* largest motion in one step over radius [-] */
        double step;    /* largest time step over the critical one of present contacts [-] */
        double energy;  /* largest balance error over the energy turned over; 0: not watched */
        double hourglass; /* largest share of a solid's internal energy; 0: not watched */
    } watch;
    int64_t order_every; /* M: steps between renewals of the canonical order (DESIGN: order) */
};

/* One `--set key=value` of the command line; key is a dotted path (spheres.0.radius counts
 * lists). */
struct job_override {
    const char *text;
};

/*
 * Reads, checks and completes the job file.  Returns false with all mistakes listed when there
 * is any.  Includes are read relative to the job file; what the job says wins.  Local: one rank
 * reads and broadcasts what job_write() makes of it; the others call job_read_text().
 */
bool job_read(struct job *job, const char *path, int n_overrides,
              const struct job_override *overrides, struct mistakes *mistakes);
/* The same of a variant of its sweep, counted from 1; 0: of the job without its sweep. */
bool job_read_variant(struct job *job, const char *path, int n_overrides,
                      const struct job_override *overrides, int variant,
                      struct mistakes *mistakes);
/* The sweep of a job file, with no variant where there is none, or where the file cannot be
 * read at all, which job_read tells.  Lists the mistakes of the sweep alone.  Local. */
bool job_read_sweep(struct sweep *sweep, const char *path, int n_overrides,
                    const struct job_override *overrides, struct mistakes *mistakes);
/* A job from a text that job_write() made; `path` is where the job came from.  Reads no
 * other file. Local. */
bool job_read_text(struct job *job, const char *path, const char *text,
                   struct mistakes *mistakes);
void job_clear(struct job *job);
void job_volume_clear(struct job_volume *volume);

/* The name of a job by its path: "hopper" of runs/../hopper.yaml.  The caller frees it. */
char *job_name(const char *path);

/* Groups of spheres: those of `spheres`, of `insert`, and of the job that this one starts from,
 * counted on in this order. */
int job_n_groups(const struct job *job);
/* NULL where there is no group of this number. */
const char *job_group_name(const struct job *job, int group);

/* Have two paths the same last part?  A folder may have been moved since it was named. */
bool job_same_file(const char *a, const char *b);

/* The job as used, every default written out, as YAML that job_read accepts and that gives
 * an equal job.  The caller frees it. */
char *job_write(const struct job *job);

/*
 * Compares two jobs' YAML as written by job_write for a resume.  What may differ (end time,
 * output, checkpoint, decomposition, force, watch, title) is ignored; the first other
 * difference is returned as "key: was X, now Y" (caller frees), NULL when there is none.
 */
char *job_difference(const char *was, const char *now);

/* The reference page jobs/README.md, generated from the schema.  The caller frees it. */
char *job_reference_page(void);

#endif
