/* Talus for programs in C: a map of what a rover knows of the ground, and routes over it. C11, no C++ in sight.
 *
 * A session is a number, not a pointer: one that was destroyed, or never was, is refused. Every call returns a code, and
 * where it fails one line in `error`, which may be NULL. No call throws, aborts or prints. Calls on one session from two
 * threads at once: the second returns TALUS_BUSY and changes nothing; talus_cancel() and talus_destroy() may come from any
 * thread at any time. Different sessions share nothing.
 *
 * Frames: x east, y north, z up [m]; headings counter-clockwise from x [rad]. Rasters: row by row from the south-west.
 * Each structure begins with its size, sizeof of its type, so that a program built against another version is told so. */
#ifndef TALUS_H
#define TALUS_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define TALUS_API __attribute__((visibility("default")))
#else
#define TALUS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef uint64_t talus_session; /* 0: none */

typedef enum talus_code {
  TALUS_OK = 0,
  TALUS_NO_ROUTE = 1,  /* proven, or none was found: talus_error says which */
  TALUS_BAD_INPUT = 2, /* a value, a size, a NULL, a session: nothing was changed */
  TALUS_FAILURE = 3,   /* of the library itself, such as no memory */
  TALUS_BUSY = 4,      /* another thread works on the session */
  TALUS_CANCELLED = 5
} talus_code;

typedef struct talus_error {
  char text[256]; /* one line: what, where, remedy; cut where it is longer */
} talus_error;

/* talus_default_rover() fills in what is common; give the rest. */
typedef struct talus_rover {
  size_t size;
  int wheel_count; /* even, 4 to 12 */
  double mass_kg;
  double gravity_m_s2;
  double wheel_radius_m, wheel_width_m;
  double wheelbase_m, track_m, clearance_m;
  double centre_of_mass_height_m;
  double max_pitch_rad, max_roll_rad;
  double max_torque_Nm; /* of a wheel */
  double max_speed_mps;
  double hotel_power_W;
} talus_rover;

typedef struct talus_soil {
  size_t size;
  int class_number; /* in the class raster, 0 to 254 */
  double cohesion_Pa, friction_angle_rad;
  double sinkage_exponent, cohesive_modulus, frictional_modulus; /* Bekker's n, k_c, k_phi in SI */
  double shear_modulus_m;
  double slip_sinkage_exponent; /* growth of the exponent with slip, 0 to 2; 0: none */
  double test_gravity_m_s2;     /* of the soil's test; in less, cohesion and moduli are less by as much; 0: that of the rover */
} talus_soil;

typedef struct talus_grid {
  size_t size;
  int width, height; /* cells west to east, south to north, > 0 */
  double resolution_m;
  double x_m, y_m; /* outer corner in the south-west */
} talus_grid;

/* Arrays of width * height values of a grid; NULL: not given. */
typedef struct talus_layers {
  size_t size;
  size_t cells;                /* of each array */
  const float* elevation_m;    /* NaN: not observed yet */
  const float* rock_abundance; /* share of the ground, 0 to 1; NaN: not observed yet */
  const uint8_t* classes;      /* numbers of soils; 255: not observed yet */
  const uint8_t* keep_out;     /* not 0: must not be entered */
} talus_layers;

/* What else is known of the ground, such as shadow or radio: joules that a metre costs more in each cell of the map's grid, 0
   to 1e6. Infinite: must not be entered. NaN: not known, refused as unobserved ground is, or, with allow_unknown, as dear as
   the dearest of the layer. At most 64 layers; a name each. */
typedef struct talus_cost_layer {
  size_t size;
  const char* name;
  const float* added_J_per_m; /* width * height values, row by row from the south-west */
} talus_cost_layer;

typedef struct talus_options {
  size_t size;
  const char* planner;   /* "field", "hybrid", ...; NULL: the default */
  int allow_unknown;     /* not 0: unobserved cells count as level ground of the first soil */
  int threads;           /* >= 1; results do not depend on it */
  uint64_t seed;         /* of planners that sample */
  double time_limit_s;   /* of a plan; 0: none */
} talus_options;

/* What one wheel read at one moment; NaN: not measured. Wheels read together have the same time_s. A reading that is
   missing or impossible is left out for what it says of strength; what its row says of danger is kept. */
typedef struct talus_wheel {
  size_t size;
  int wheel; /* its number on the rover */
  double time_s, x_m, y_m;
  double load_N, slip;
  double torque_Nm, sinkage_m, slope_rad, heading_rad;
  double pose_std_m; /* how well the place is known */
} talus_wheel;

typedef struct talus_request {
  size_t size;
  double start_x_m, start_y_m, goal_x_m, goal_y_m;
  double tolerance_m; /* the route may end so far from the goal, >= 0 */
} talus_request;

typedef struct talus_summary {
  size_t size;
  size_t vertices;
  double cost_J, lower_bound_J, energy_J, time_s, length_m;
  double max_slip, max_slope_rad;
  double immobilisation_risk;
} talus_summary;

typedef struct talus_vertex {
  double x_m, y_m, heading_rad;
  double slope_along_rad, slip, sinkage_m, torque_Nm;
  double energy_J, time_s, immobilisation_risk; /* from the start to here */
  double elevation_m; /* of the ground; NaN: not observed */
} talus_vertex;

typedef struct talus_cell {
  float pull_mean, pull_std;       /* believed drawbar pull over load at slip 0.5 */
  float sinkage_mean, sinkage_std; /* over wheel radius */
  uint8_t category;                /* 0 safe, 1 marginal, 2 dangerous, 3 unknown */
  uint8_t hazards;                 /* bits: 1 unknown, 2 slope, 4 step, 8 roughness, 16 rocks, 32 keep-out, 64 obstacle, 128 near */
  uint8_t reserved[2];             /* 0 */
} talus_cell;

TALUS_API void talus_default_rover(talus_rover* rover);
TALUS_API void talus_default_soil(talus_soil* soil);
TALUS_API void talus_default_options(talus_options* options);

/* A map and a planner. `layers` needs elevation_m, which may be all NaN; `soils` at least one. */
TALUS_API talus_code talus_create(const talus_rover* rover, const talus_soil* soils, size_t soil_count, const talus_grid* grid,
                        const talus_layers* layers, const talus_options* options, talus_session* session,
                        talus_error* error);

/* The same with `cost_count` cost layers; `costs` may be NULL where that is 0. */
TALUS_API talus_code talus_create_with_costs(const talus_rover* rover, const talus_soil* soils, size_t soil_count,
                            const talus_grid* grid, const talus_layers* layers, const talus_cost_layer* costs,
                            size_t cost_count, const talus_options* options, talus_session* session, talus_error* error);

/* A map from a file that `talus costmap` or talus_save() wrote, with its rover, soils and what wheels taught, and a planner. Of the
   options, allow_unknown must be 0: the file has its own. */
TALUS_API talus_code talus_open(const char* path, const talus_options* options, talus_session* session, talus_error* error);

/* Writes the map, rover, soils and what wheels taught into a file that talus_open() and `talus plan --map` read: the whole file or
   none. Rows that talus_settle() judges again are not in it. */
TALUS_API talus_code talus_save(talus_session session, const char* path, talus_error* error);

/* Moves the map with the rover, by whole tiles of 64 cells east and north (negative: west, south): what lies in both windows
   keeps what is known and estimated of it, what comes in is unseen, what falls off is forgotten. No route is left to be read,
   and the wheels' sensors prove themselves from the start before they raise an estimate. */
TALUS_API talus_code talus_move(talus_session session, int east_tiles, int north_tiles, talus_error* error);

/* Where the cells of the map lie now; set grid->size first. */
TALUS_API talus_code talus_read_grid(talus_session session, talus_grid* grid, talus_error* error);

/* New ground in a window on the map's cells; what is NaN, or class 255, stays as it is. */
TALUS_API talus_code talus_patch(talus_session session, const talus_grid* grid, const talus_layers* layers, talus_error* error);

/* Wheel telemetry, whole moments in order of time. `used` (may be NULL): rows that taught something. A session keeps its rows, of
   some 400 bytes each, until it is moved or destroyed. */
TALUS_API talus_code talus_learn(talus_session session, const talus_wheel* rows, size_t count, size_t* used, talus_error* error);

/* Judges all rows since the session began or was moved again, by what all of them say of the sensors: the map is then that of
   one file of these rows (`talus update`) where all of them are sound: of a number beyond its range this leaves the number out, a file
   the row. It takes as long as they took to learn, and does nothing without rows. Once a stop, or before a plan that matters. */
TALUS_API talus_code talus_settle(talus_session session, talus_error* error);

/* A route over all that is known now; it stays to be read until the next plan. `summary` may be NULL. */
TALUS_API talus_code talus_plan(talus_session session, const talus_request* request, talus_summary* summary, talus_error* error);

/* Ends the plan that runs now, if one does, with TALUS_CANCELLED or the best route so far. */
TALUS_API talus_code talus_cancel(talus_session session, talus_error* error);

/* Vertices from number `first` on into a buffer of `capacity`; `written`: how many. */
TALUS_API talus_code talus_read_route(talus_session session, size_t first, talus_vertex* buffer, size_t capacity, size_t* written,
                            talus_error* error);

/* The cells of a box, row by row, into a buffer of at least width * height. */
TALUS_API talus_code talus_read_cells(talus_session session, int column, int row, int width, int height, talus_cell* buffer,
                            size_t capacity, talus_error* error);

/* Ends the session; a plan that runs in another thread is cancelled and ends by itself. */
TALUS_API talus_code talus_destroy(talus_session session, talus_error* error);

#ifdef __cplusplus
}
#endif

#endif
