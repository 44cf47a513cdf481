/* C interface of Talus: a traversability map of a rover's surroundings, and routes over the map. C11; needs no C++.
 *
 * A session is a number, not a pointer; the number of a destroyed or unknown session returns TALUS_BAD_INPUT. Every call
 * returns a code, and on failure writes one line to `error`, which may be NULL. No call throws, aborts or prints. If two
 * threads call the same session at once, the second call returns TALUS_BUSY and changes nothing; talus_cancel() and
 * talus_destroy() may be called from any thread at any time. Different sessions are independent.
 *
 * Frames: x east, y north, z up [m]; headings counter-clockwise from x [rad]. Rasters: row by row from the south-west.
 * The first member of most structures is `size`, the sizeof of the structure. A call that reads a structure of another
 * size, from a program built against another version of this header, returns TALUS_BAD_INPUT. */
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

typedef uint64_t talus_session; /* 0: no session */

typedef enum talus_code {
  TALUS_OK = 0,
  TALUS_NO_ROUTE = 1,  /* proven, none found, or time limit reached: see talus_error */
  TALUS_BAD_INPUT = 2, /* invalid value, size, NULL or session */
  TALUS_FAILURE = 3,   /* internal failure, for example out of memory */
  TALUS_BUSY = 4,      /* another thread uses the session */
  TALUS_CANCELLED = 5
} talus_code;

typedef struct talus_error {
  char text[256]; /* one line: problem, place, remedy; truncated to fit; empty on success */
} talus_error;

/* talus_default_rover() sets common values of wheel_count, gravity, limits and speed; the caller sets the rest. */
typedef struct talus_rover {
  size_t size;
  int wheel_count; /* even, 4 to 12 */
  double mass_kg;
  double gravity_m_s2;
  double wheel_radius_m, wheel_width_m;
  double wheelbase_m, track_m, clearance_m;
  double centre_of_mass_height_m;
  double max_pitch_rad, max_roll_rad;
  double max_torque_Nm; /* per wheel */
  double max_speed_mps;
  double hotel_power_W;
} talus_rover;

typedef struct talus_soil {
  size_t size;
  int class_number; /* value in the class raster, 0 to 254 */
  double cohesion_Pa, friction_angle_rad;
  double sinkage_exponent, cohesive_modulus, frictional_modulus; /* Bekker's n, k_c, k_phi in SI */
  double shear_modulus_m;
  double slip_sinkage_exponent; /* increase of the exponent with slip, 0 to 2 */
  double test_gravity_m_s2;     /* gravity of the soil test; cohesion and moduli scale with the rover's gravity; 0: the rover's */
} talus_soil;

typedef struct talus_grid {
  size_t size;
  int width, height; /* cells west to east, south to north, > 0 */
  double resolution_m;
  double x_m, y_m; /* south-western outer corner */
} talus_grid;

/* Layers of a grid, each an array of width * height values; NULL: not given. */
typedef struct talus_layers {
  size_t size;
  size_t cells;                /* size of each array: width * height */
  const float* elevation_m;    /* NaN: not observed yet */
  const float* rock_abundance; /* area fraction, 0 to 1; NaN: not observed yet */
  const uint8_t* classes;      /* class numbers of soils; 255: not observed yet */
  const uint8_t* keep_out;     /* not 0: the rover must not enter */
} talus_layers;

/* Additional cost per metre [J/m] in each cell of the map's grid, 0 to 1e6, for example for shadow or radio coverage.
   Infinite: the rover must not enter. NaN: not known; refused as unobserved ground, or, with allow_unknown, set to the
   highest finite cost of the layer. At most 64 layers, each with its own name. */
typedef struct talus_cost_layer {
  size_t size;
  const char* name;
  const float* added_J_per_m; /* width * height values, row by row from the south-west */
} talus_cost_layer;

typedef struct talus_options {
  size_t size;
  const char* planner;   /* "field", "hybrid", ...; NULL: default */
  int allow_unknown;     /* not 0: unobserved cells are level ground of the first soil */
  int threads;           /* >= 1; results do not depend on the number */
  uint64_t seed;         /* for sampling planners */
  double time_limit_s;   /* per plan; 0: no limit */
} talus_options;

/* Readings of one wheel at one time; NaN: not measured. Wheels measured together have the same time_s. A missing or
   impossible value is not used to estimate the soil's strength; the row's other values are still checked for danger. */
typedef struct talus_wheel {
  size_t size;
  int wheel; /* wheel number on the rover */
  double time_s, x_m, y_m;
  double load_N, slip;
  double torque_Nm, sinkage_m, slope_rad, heading_rad;
  double pose_std_m; /* standard deviation of the position */
} talus_wheel;

typedef struct talus_request {
  size_t size;
  double start_x_m, start_y_m, goal_x_m, goal_y_m; /* -1e9 to 1e9 */
  double tolerance_m; /* largest distance of the route's end from the goal, >= 0 */
} talus_request;

typedef struct talus_summary {
  size_t size;
  size_t vertices; /* number of vertices; 0 without a route */
  double cost_J, lower_bound_J, energy_J, time_s, length_m; /* lower_bound_J: no route costs less */
  double max_slip, max_slope_rad;
  double immobilisation_risk; /* probability, 0 to 1 */
  double energy_p90_J, time_p90_s; /* not exceeded with probability 0.9; energy_J and time_s are expected */
} talus_summary;

typedef struct talus_vertex {
  double x_m, y_m, heading_rad;
  double slope_along_rad, slip, sinkage_m, torque_Nm; /* up to the next vertex; torque per wheel */
  double energy_J, time_s, immobilisation_risk; /* accumulated from the start */
  double elevation_m; /* ground elevation; NaN: not observed */
} talus_vertex;

typedef struct talus_cell {
  float pull_mean, pull_std;       /* estimated drawbar pull over load (DP/W) at slip 0.5 */
  float sinkage_mean, sinkage_std; /* estimated sinkage over wheel radius */
  uint8_t category;                /* 0 safe, 1 marginal, 2 dangerous, 3 unknown */
  uint8_t hazards;                 /* bits: 1 unknown, 2 slope, 4 step, 8 roughness, 16 rocks, 32 keep-out, 64 obstacle, 128 near */
  uint8_t reserved[2];             /* 0 */
} talus_cell;

/* Set a structure to default values and its size; NULL is ignored. */
TALUS_API void talus_default_rover(talus_rover* rover);
TALUS_API void talus_default_soil(talus_soil* soil);
TALUS_API void talus_default_options(talus_options* options);

/* Creates a session with a map and a planner. `layers` must have elevation_m, which may be all NaN; `soil_count` is 1 to
   254. */
TALUS_API talus_code talus_create(const talus_rover* rover, const talus_soil* soils, size_t soil_count, const talus_grid* grid,
                        const talus_layers* layers, const talus_options* options, talus_session* session,
                        talus_error* error);

/* As talus_create(), with `cost_count` cost layers; `costs` may be NULL if `cost_count` is 0. */
TALUS_API talus_code talus_create_with_costs(const talus_rover* rover, const talus_soil* soils, size_t soil_count,
                            const talus_grid* grid, const talus_layers* layers, const talus_cost_layer* costs,
                            size_t cost_count, const talus_options* options, talus_session* session, talus_error* error);

/* Creates a session from a map file of `talus costmap` or talus_save(), with the file's rover, soils and soil evidence, and
   a planner. options->allow_unknown must be 0, because the file has its own value. */
TALUS_API talus_code talus_open(const char* path, const talus_options* options, talus_session* session, talus_error* error);

/* Writes map, rover, soils and soil evidence to a file for talus_open() and `talus plan --map`, either completely or not at
   all. The telemetry rows that talus_settle() re-evaluates are not saved. */
TALUS_API talus_code talus_save(talus_session session, const char* path, talus_error* error);

/* Moves the map with the rover by whole tiles of 64 cells east and north (negative: west, south). Cells in both windows
   keep their layers and estimates, new cells are unobserved, and cells outside the new window are discarded. The route is
   discarded; the drive under way goes on. */
TALUS_API talus_code talus_move(talus_session session, int east_tiles, int north_tiles, talus_error* error);

/* Reads the grid of the map; the caller sets grid->size first. */
TALUS_API talus_code talus_read_grid(talus_session session, talus_grid* grid, talus_error* error);

/* Updates layers in a window aligned with the map's cells; NaN and class 255 leave a cell unchanged. */
TALUS_API talus_code talus_patch(talus_session session, const talus_grid* grid, const talus_layers* layers, talus_error* error);

/* Adds wheel telemetry in order of time; a call must contain all rows of a time. `used` (may be NULL) returns the number of
   rows used for estimates. A session stores its rows, about 400 bytes each, until it is destroyed. */
TALUS_API talus_code talus_learn(talus_session session, const talus_wheel* rows, size_t count, size_t* used, talus_error* error);

/* Re-evaluates all rows since the session began, with the sensor checks based on all rows. The map then equals
   that of `talus update` with one file of these rows, if all rows are valid: for a number out of range this call omits the
   number, `talus update` the row. Takes as long as adding the rows; does nothing without rows. Recommended at each stop of
   the rover and before important plans. */
TALUS_API talus_code talus_settle(talus_session session, talus_error* error);

/* Plans a route on the current map. The route can be read until the next plan. `summary` may be NULL. */
TALUS_API talus_code talus_plan(talus_session session, const talus_request* request, talus_summary* summary, talus_error* error);

/* Stops the running plan, if any; that plan returns TALUS_CANCELLED or the best route so far. */
TALUS_API talus_code talus_cancel(talus_session session, talus_error* error);

/* Copies the route's vertices from number `first` into a buffer of `capacity`; `written` returns their number. */
TALUS_API talus_code talus_read_route(talus_session session, size_t first, talus_vertex* buffer, size_t capacity, size_t* written,
                            talus_error* error);

/* Copies the cells of a box, row by row, into a buffer of at least width * height cells. */
TALUS_API talus_code talus_read_cells(talus_session session, int column, int row, int width, int height, talus_cell* buffer,
                            size_t capacity, talus_error* error);

/* Destroys the session. A plan running in another thread is cancelled and returns to its caller. */
TALUS_API talus_code talus_destroy(talus_session session, talus_error* error);

#ifdef __cplusplus
}
#endif

#endif
