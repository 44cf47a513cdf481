/* The C interface from C: what it refuses, buffers with sizes, two threads. Ends with 0, or with the line that failed. */
#define _POSIX_C_SOURCE 200809L /* mkstemp */
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <talus.h>

enum { SIDE = 60, CELLS = SIDE * SIDE, ROUNDS = 40 };

static float heights[CELLS];
static talus_error error;

#define CHECK(holds)                                                               \
  do {                                                                             \
    if (!(holds)) {                                                                \
      fprintf(stderr, "line %d: %s: '%s'\n", __LINE__, #holds, error.text);        \
      exit(1);                                                                     \
    }                                                                              \
  } while (0)

#define REFUSED(call, word)                            \
  do {                                                 \
    CHECK((call) == TALUS_BAD_INPUT);                  \
    CHECK(strstr(error.text, word) != NULL);           \
    CHECK(strchr(error.text, '\n') == NULL);           \
  } while (0)

static talus_rover rover;
static talus_soil soil;
static talus_options options;
static talus_grid grid = {sizeof grid, SIDE, SIDE, 0.5, 0.0, 0.0};
static talus_layers layers = {sizeof layers, CELLS, heights, NULL, NULL, NULL};

static void describe(void) {
  talus_default_rover(&rover);
  rover.mass_kg = 90.0;
  rover.gravity_m_s2 = 1.62;
  rover.wheel_radius_m = rover.wheel_width_m = 0.2;
  rover.wheelbase_m = 0.9;
  rover.track_m = 0.8;
  rover.clearance_m = 0.2;
  rover.max_torque_Nm = 40.0;
  talus_default_soil(&soil);
  soil.cohesion_Pa = 170.0;
  soil.friction_angle_rad = 0.61;
  soil.cohesive_modulus = 1400.0;
  soil.frictional_modulus = 820000.0;
  talus_default_options(&options);
}

static talus_session made(void) {
  talus_session session = 0;
  CHECK(talus_create(&rover, &soil, 1, &grid, &layers, &options, &session, &error) == TALUS_OK);
  CHECK(session != 0);
  return session;
}

/* Every NULL, wrong size and wrong value is one line; `session` keeps what it held. */
static void refusesWhatCannotBe(void) {
  talus_session session = 77;
  talus_rover heavy = rover;
  talus_soil odd = soil;
  talus_options threads = options;
  talus_layers few = layers;
  talus_grid flat = grid;
  REFUSED(talus_create(NULL, &soil, 1, &grid, &layers, &options, &session, &error), "rover is NULL");
  REFUSED(talus_create(&rover, NULL, 1, &grid, &layers, &options, &session, &error), "soils is NULL");
  REFUSED(talus_create(&rover, &soil, 0, &grid, &layers, &options, &session, &error), "soil_count = 0");
  REFUSED(talus_create(&rover, &soil, 1, NULL, &layers, &options, &session, &error), "grid is NULL");
  REFUSED(talus_create(&rover, &soil, 1, &grid, NULL, &options, &session, &error), "layers is NULL");
  REFUSED(talus_create(&rover, &soil, 1, &grid, &layers, NULL, &session, &error), "options is NULL");
  REFUSED(talus_create(&rover, &soil, 1, &grid, &layers, &options, NULL, &error), "session is NULL");
  CHECK(talus_create(NULL, &soil, 1, &grid, &layers, &options, &session, NULL) == TALUS_BAD_INPUT);
  heavy.size -= 8;
  REFUSED(talus_create(&heavy, &soil, 1, &grid, &layers, &options, &session, &error), "rover.size");
  heavy = rover;
  heavy.mass_kg = -1.0;
  REFUSED(talus_create(&heavy, &soil, 1, &grid, &layers, &options, &session, &error), "mass_kg");
  odd.friction_angle_rad = NAN;
  REFUSED(talus_create(&rover, &odd, 1, &grid, &layers, &options, &session, &error), "friction_angle_rad");
  threads.threads = 0;
  REFUSED(talus_create(&rover, &soil, 1, &grid, &layers, &threads, &session, &error), "threads = 0");
  threads = options;
  threads.planner = "feild";
  REFUSED(talus_create(&rover, &soil, 1, &grid, &layers, &threads, &session, &error), "field");
  few.cells = CELLS - 1;
  REFUSED(talus_create(&rover, &soil, 1, &grid, &few, &options, &session, &error), "layers.cells = 3599, must be");
  few = layers;
  few.elevation_m = NULL;
  REFUSED(talus_create(&rover, &soil, 1, &grid, &few, &options, &session, &error), "elevation_m is NULL");
  flat.width = 0;
  REFUSED(talus_create(&rover, &soil, 1, &flat, &layers, &options, &session, &error), "width");
  CHECK(session == 77);
}

/* Numbers that no file may hold are refused here, too, before any value is read. */
static void keepsTheRangesOfFiles(void) {
  talus_session session = 77, open_session;
  talus_grid wrong = grid;
  talus_layers many = layers;
  talus_request far = {sizeof far, 5.0, 10.0, 25.0, 10.0, 0.0};
  talus_wheel row = {sizeof row, 0, 0.0, 1e300, 10.0, 36.5, 0.95, NAN, 0.1, 0.0, 0.0, 0.1};
  size_t used = 7;
  wrong.width = wrong.height = INT_MAX;
  many.cells = (size_t)INT_MAX * INT_MAX;
  REFUSED(talus_create(&rover, &soil, 1, &wrong, &many, &options, &session, &error),
          "grid: 2147483647 x 2147483647 cells, must be at most 400000000");
  wrong = grid;
  wrong.x_m = 1e300;
  REFUSED(talus_create(&rover, &soil, 1, &wrong, &layers, &options, &session, &error),
          "grid: x_m = 1e+300, must be -1e9 to 1e9");
  wrong = grid;
  wrong.resolution_m = 1e300;
  REFUSED(talus_create(&rover, &soil, 1, &wrong, &layers, &options, &session, &error), "must be 0.001 to 1e6");
  CHECK(session == 77);
  open_session = made();
  wrong = grid;
  wrong.width = wrong.height = INT_MAX;
  REFUSED(talus_patch(open_session, &wrong, &many, &error), "must be at most 400000000");
  wrong.width = wrong.height = 20000;
  many.cells = 400000000;
  REFUSED(talus_patch(open_session, &wrong, &many, &error), "off the map");
  far.goal_x_m = 1e300;
  REFUSED(talus_plan(open_session, &far, NULL, &error), "request: goal_x_m = 1e+300, must be -1e9 to 1e9");
  CHECK(talus_learn(open_session, &row, 1, &used, &error) == TALUS_OK && used == 0);
  CHECK(talus_destroy(open_session, &error) == TALUS_OK);
}

static void patchesPlansAndReadsBack(void) {
  const talus_session session = made();
  talus_request request = {sizeof request, 5.0, 10.0, 25.0, 10.0, 0.0};
  talus_summary summary;
  static float wall[4 * 36];
  static uint8_t out[4 * 36];
  talus_grid window = {sizeof window, 4, 36, 0.5, 14.0, 0.0};
  talus_layers seen = {sizeof seen, 4 * 36, wall, NULL, NULL, out};
  talus_vertex vertices[3];
  static talus_vertex all[1000];
  talus_cell cells[4];
  size_t count = 0, first = 0, i;
  memset(out, 1, sizeof out);
  summary.size = sizeof summary;
  CHECK(talus_plan(session, &request, &summary, &error) == TALUS_OK);
  CHECK(fabs(summary.length_m - 20.0) < 1e-6); /* Closed form: straight over level ground */
  REFUSED(talus_read_cells(session, 59, 0, 2, 1, cells, 4, &error), "cut it to the map");
  REFUSED(talus_read_cells(session, 0, 0, 2, 3, cells, 4, &error), "capacity = 4, must be >= 6");
  CHECK(talus_read_cells(session, 28, 10, 2, 2, cells, 4, &error) == TALUS_OK);
  CHECK(cells[0].hazards == 0 && cells[0].pull_mean > 0.1F && cells[0].category <= 1);
  CHECK(talus_patch(session, &window, &seen, &error) == TALUS_OK);
  CHECK(talus_read_cells(session, 28, 10, 2, 2, cells, 4, &error) == TALUS_OK);
  CHECK((cells[0].hazards & 32) != 0 && cells[0].category == 2);
  CHECK(talus_plan(session, &request, &summary, &error) == TALUS_OK);
  CHECK(summary.length_m > 24.0); /* around the wall, which ends at y = 18 */
  CHECK(summary.lower_bound_J <= summary.cost_J);
  do { /* in threes, and at once: the same */
    CHECK(talus_read_route(session, first, vertices, 3, &count, &error) == TALUS_OK);
    memcpy(all + first, vertices, count * sizeof *vertices);
    first += count;
  } while (count == 3);
  CHECK(first == summary.vertices);
  CHECK(talus_read_route(session, 0, all + 500, 500, &count, &error) == TALUS_OK && count == first);
  for (i = 0; i < count; ++i) CHECK(memcmp(&all[i], &all[500 + i], sizeof *all) == 0);
  CHECK(talus_read_route(session, 1000000, vertices, 3, &count, &error) == TALUS_OK && count == 0);
  window.x_m = 1000.0;
  REFUSED(talus_patch(session, &window, &seen, &error), "off the map");
  request.goal_x_m = 15.0; /* inside the wall */
  CHECK(talus_plan(session, &request, NULL, &error) == TALUS_BAD_INPUT && strstr(error.text, "goal") != NULL);
  request.goal_x_m = NAN;
  CHECK(talus_plan(session, &request, NULL, &error) == TALUS_BAD_INPUT);
  summary.size = 3;
  request.goal_x_m = 25.0;
  REFUSED(talus_plan(session, &request, &summary, &error), "summary.size = 3");
  CHECK(talus_destroy(session, &error) == TALUS_OK);
  REFUSED(talus_destroy(session, &error), "is not open");
  REFUSED(talus_plan(session, &request, NULL, &error), "is not open");
  REFUSED(talus_cancel(session, &error), "is not open");
}

static void learnsFromWheels(void) {
  const talus_session session = made();
  talus_wheel row = {sizeof row, 0, 0.0, 10.0, 10.0, 36.5, 0.5, NAN, 0.1, 0.0, 0.0, 0.1};
  talus_cell before, after;
  size_t used = 99, k;
  CHECK(talus_read_cells(session, 20, 20, 1, 1, &before, 1, &error) == TALUS_OK);
  CHECK(talus_settle(session, &error) == TALUS_OK); /* nothing was learned */
  for (k = 0; k < 5; ++k) {
    row.time_s = (double)k;
    CHECK(talus_learn(session, &row, 1, &used, &error) == TALUS_OK);
  }
  CHECK(used == 1);
  CHECK(talus_read_cells(session, 20, 20, 1, 1, &after, 1, &error) == TALUS_OK);
  CHECK(after.pull_mean < before.pull_mean && after.sinkage_mean > before.sinkage_mean);
  REFUSED(talus_learn(session, NULL, 1, &used, &error), "rows is NULL");
  CHECK(talus_settle(session, &error) == TALUS_OK); /* of one wheel that never climbed nothing is proven: no change */
  CHECK(talus_read_cells(session, 20, 20, 1, 1, &before, 1, &error) == TALUS_OK);
  CHECK(memcmp(&before, &after, sizeof after) == 0);
  CHECK(talus_destroy(session, &error) == TALUS_OK);
  REFUSED(talus_settle(session, &error), "is not open");
}

/* Property: a map that was saved and opened has the same cells and the same route, what wheels taught included. */
static void savesAndOpens(void) {
  const talus_session session = made();
  const talus_wheel row = {sizeof row, 0, 0.0, 10.0, 10.0, 36.5, 0.5, NAN, 0.1, 0.0, 0.0, 0.1};
  const talus_request request = {sizeof request, 5.0, 10.0, 25.0, 10.0, 0.0};
  static talus_cell before[CELLS], after[CELLS];
  talus_summary first, second;
  talus_session opened = 0;
  char path[] = "/tmp/talus-c-XXXXXX";
  FILE *file;
  const int descriptor = mkstemp(path);
  CHECK(descriptor >= 0 && close(descriptor) == 0);
  first.size = second.size = sizeof first;
  CHECK(talus_learn(session, &row, 1, NULL, &error) == TALUS_OK);
  CHECK(talus_save(session, path, &error) == TALUS_OK);
  CHECK(talus_open(path, &options, &opened, &error) == TALUS_OK && opened != session);
  CHECK(talus_read_cells(session, 0, 0, grid.width, grid.height, before, CELLS, &error) == TALUS_OK);
  CHECK(talus_read_cells(opened, 0, 0, grid.width, grid.height, after, CELLS, &error) == TALUS_OK);
  CHECK(memcmp(before, after, sizeof before) == 0);
  CHECK(talus_plan(session, &request, &first, &error) == TALUS_OK);
  CHECK(talus_plan(opened, &request, &second, &error) == TALUS_OK);
  CHECK(memcmp(&first, &second, sizeof first) == 0);
  options.allow_unknown = 1;
  REFUSED(talus_open(path, &options, &opened, &error), "allow_unknown is the map file's own");
  options.allow_unknown = 0;
  REFUSED(talus_open("/nowhere/site.ot", &options, &opened, &error), "/nowhere/site.ot");
  REFUSED(talus_open(NULL, &options, &opened, &error), "path is NULL");
  REFUSED(talus_save(session, "/nowhere/site.ot", &error), "/nowhere");
  file = fopen(path, "r+b");
  CHECK(file != NULL && fseek(file, 100, SEEK_SET) == 0 && fputc('?', file) == '?' && fclose(file) == 0);
  REFUSED(talus_open(path, &options, &opened, &error), path);
  CHECK(remove(path) == 0);
  CHECK(talus_destroy(session, &error) == TALUS_OK && talus_destroy(opened, &error) == TALUS_OK);
  REFUSED(talus_save(session, path, &error), "is not open");
}

/* A layer refuses a wall and makes the rest dearer; what a layer cannot be is one line. */
static void countsCostLayers(void) {
  static float radio[CELLS];
  talus_cost_layer cost = {sizeof cost, "radio", radio};
  const talus_request request = {sizeof request, 5.0, 10.0, 25.0, 10.0, 0.0};
  talus_session session = 77;
  talus_summary plain, dear;
  const talus_session bare = made();
  int k;
  plain.size = dear.size = sizeof plain;
  CHECK(talus_plan(bare, &request, &plain, &error) == TALUS_OK);
  CHECK(talus_destroy(bare, &error) == TALUS_OK);
  for (k = 0; k < CELLS; ++k) radio[k] = 20.0F;
  CHECK(talus_create_with_costs(&rover, &soil, 1, &grid, &layers, &cost, 1, &options, &session, &error) == TALUS_OK);
  CHECK(talus_plan(session, &request, &dear, &error) == TALUS_OK);
  CHECK(fabs(dear.energy_J - plain.energy_J - 20.0 * 20.0) < 1e-3); /* Closed form: 20 m of 20 J/m */
  CHECK(talus_destroy(session, &error) == TALUS_OK);
  for (k = 0; k < 36; ++k) radio[k * SIDE + 30] = INFINITY;
  CHECK(talus_create_with_costs(&rover, &soil, 1, &grid, &layers, &cost, 1, &options, &session, &error) == TALUS_OK);
  CHECK(talus_plan(session, &request, &dear, &error) == TALUS_OK);
  CHECK(dear.length_m > 24.0); /* around the wall, which ends at y = 18 */
  CHECK(talus_destroy(session, &error) == TALUS_OK);
  session = 77;
  REFUSED(talus_create_with_costs(&rover, &soil, 1, &grid, &layers, NULL, 1, &options, &session, &error), "costs is NULL");
  REFUSED(talus_create_with_costs(&rover, &soil, 1, &grid, &layers, &cost, 65, &options, &session, &error), "cost_count = 65");
  radio[7] = -1.0F;
  REFUSED(talus_create_with_costs(&rover, &soil, 1, &grid, &layers, &cost, 1, &options, &session, &error), "radio");
  cost.name = NULL;
  REFUSED(talus_create_with_costs(&rover, &soil, 1, &grid, &layers, &cost, 1, &options, &session, &error), "name is NULL");
  cost.size = 1;
  REFUSED(talus_create_with_costs(&rover, &soil, 1, &grid, &layers, &cost, 1, &options, &session, &error), "size = 1");
  CHECK(session == 77);
}

/* A map of 192 x 64 cells moves one tile east: what lies in both windows stays to the bit, the rest is unseen. */
static void movesWithTheRover(void) {
  enum { WIDE = 192, HIGH = 64 };
  static float ground[WIDE * HIGH];
  static talus_cell before[WIDE * HIGH], after[WIDE * HIGH];
  const talus_grid wide = {sizeof wide, WIDE, HIGH, 0.5, 0.0, 0.0};
  const talus_layers level = {sizeof level, WIDE * HIGH, ground, NULL, NULL, NULL};
  const talus_request request = {sizeof request, 40.0, 10.0, 60.0, 10.0, 0.0};
  talus_wheel row = {sizeof row, 0, 0.0, 60.0, 16.0, 36.5, 0.5, NAN, 0.1, 0.0, 0.0, 0.1};
  talus_session session = 0;
  talus_grid now = {sizeof now, 0, 0, 0.0, 0.0, 0.0};
  talus_vertex vertex;
  size_t count = 9;
  int r, c, k;
  CHECK(talus_create(&rover, &soil, 1, &wide, &level, &options, &session, &error) == TALUS_OK);
  for (k = 0; k < 5; ++k) {
    row.time_s = k;
    CHECK(talus_learn(session, &row, 1, NULL, &error) == TALUS_OK);
  }
  CHECK(talus_plan(session, &request, NULL, &error) == TALUS_OK);
  CHECK(talus_read_cells(session, 0, 0, WIDE, HIGH, before, WIDE * HIGH, &error) == TALUS_OK);
  REFUSED(talus_move(session, 3, 0, &error), "leaves nothing");
  CHECK(talus_read_grid(session, &now, &error) == TALUS_OK && now.x_m == 0.0);
  CHECK(talus_move(session, 1, 0, &error) == TALUS_OK);
  CHECK(talus_read_grid(session, &now, &error) == TALUS_OK);
  CHECK(now.x_m == 32.0 && now.y_m == 0.0 && now.width == WIDE && now.height == HIGH && now.resolution_m == 0.5);
  CHECK(talus_read_route(session, 0, &vertex, 1, &count, &error) == TALUS_OK && count == 0);
  CHECK(talus_read_cells(session, 0, 0, WIDE, HIGH, after, WIDE * HIGH, &error) == TALUS_OK);
  for (r = 8; r < HIGH - 8; ++r) /* clear of the borders, where a footprint meets unseen ground */
    for (c = 8; c < WIDE - 64 - 8; ++c) CHECK(memcmp(&after[r * WIDE + c], &before[r * WIDE + c + 64], sizeof *after) == 0);
  CHECK(after[32 * WIDE + 56].pull_mean < after[32 * WIDE + 90].pull_mean); /* where the wheel was: x = 60 m */
  CHECK((after[32 * WIDE + WIDE - 1].hazards & 1) != 0);
  CHECK(talus_plan(session, &request, NULL, &error) == TALUS_OK);
  CHECK(talus_learn(session, &row, 1, NULL, &error) == TALUS_OK);
  now.size = 3;
  REFUSED(talus_read_grid(session, &now, &error), "grid.size = 3");
  REFUSED(talus_read_grid(session, NULL, &error), "grid is NULL");
  CHECK(talus_destroy(session, &error) == TALUS_OK);
  REFUSED(talus_move(session, 1, 0, &error), "is not open");
}

/* Three wheels spin; what the fourth's sensors say, or do not, takes nothing from that. */
static void hearsDangerBesideADeadSensor(void) {
  const struct {
    size_t at;
    double value;
  } dead[] = {{offsetof(talus_wheel, slip), 0.97},         {offsetof(talus_wheel, slip), NAN},
              {offsetof(talus_wheel, slip), 1.02},         {offsetof(talus_wheel, slip), INFINITY},
              {offsetof(talus_wheel, load_N), NAN},        {offsetof(talus_wheel, load_N), 0.0},
              {offsetof(talus_wheel, time_s), NAN},        {offsetof(talus_wheel, sinkage_m), -1.0},
              {offsetof(talus_wheel, pose_std_m), -INFINITY}};
  size_t c, used;
  int moment, wheel;
  for (c = 0; c < sizeof dead / sizeof dead[0]; ++c) {
    const talus_session session = made();
    talus_cell cell;
    for (moment = 0; moment < 5; ++moment) {
      talus_wheel rows[4];
      for (wheel = 0; wheel < 4; ++wheel) {
        const talus_wheel row = {sizeof row, wheel, moment, 10.0, 10.0, 36.5, 0.97, 3.0, 0.1, 0.0, 0.0, 0.1};
        rows[wheel] = row;
      }
      memcpy((char *)&rows[3] + dead[c].at, &dead[c].value, sizeof dead[c].value);
      CHECK(talus_learn(session, rows, 4, &used, &error) == TALUS_OK);
    }
    CHECK(talus_read_cells(session, 20, 20, 1, 1, &cell, 1, &error) == TALUS_OK);
    CHECK(cell.category == 2);
    CHECK(talus_destroy(session, &error) == TALUS_OK);
  }
}

/* Two threads on one session: each call is done whole, or busy; a third session is nobody's business. */
static talus_session shared;
static atomic_int done, busy, wrong;

static void *work(void *unused) {
  const talus_request request = {sizeof request, 5.0, 10.0, 25.0, 10.0, 0.0};
  talus_error mine;
  int k;
  (void)unused;
  for (k = 0; k < ROUNDS; ++k) {
    const talus_code code = k % 2 == 0   ? talus_plan(shared, &request, NULL, &mine)
                            : k % 4 == 1 ? talus_patch(shared, &grid, &layers, &mine)
                                         : talus_move(shared, 0, 0, &mine);
    if (code == TALUS_OK)
      atomic_fetch_add(&done, 1);
    else if (code == TALUS_BUSY)
      atomic_fetch_add(&busy, 1);
    else if (code != TALUS_CANCELLED)
      atomic_fetch_add(&wrong, 1);
    if (k % 8 == 7) talus_cancel(shared, &mine);
  }
  return NULL;
}

static void servesTwoThreads(void) {
  pthread_t threads[2];
  int i;
  shared = made();
  for (i = 0; i < 2; ++i) CHECK(pthread_create(&threads[i], NULL, work, NULL) == 0);
  for (i = 0; i < 2; ++i) CHECK(pthread_join(threads[i], NULL) == 0);
  CHECK(atomic_load(&wrong) == 0);
  CHECK(atomic_load(&done) > 0);
  CHECK(talus_destroy(shared, &error) == TALUS_OK);
}

int main(void) {
  describe();
  refusesWhatCannotBe();
  keepsTheRangesOfFiles();
  patchesPlansAndReadsBack();
  learnsFromWheels();
  savesAndOpens();
  countsCostLayers();
  movesWithTheRover();
  hearsDangerBesideADeadSensor();
  servesTwoThreads();
  return 0;
}
