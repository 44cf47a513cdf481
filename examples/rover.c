/* Shows   Talus in a rover's loop in C: observe the ground, plan, drive a little, process wheel telemetry.
 * Needs   talus::c, that is talus.h and libtalus.so.
 * Prints  one line per step: position, remaining length and energy.
 * Next    rover_loop.cpp: the same in C++. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <talus.h>

enum { WIDTH = 80, HEIGHT = 60, SEEN = 24 };

static float heights[WIDTH * HEIGHT];
static float seen[SEEN * SEEN];
static uint8_t rocks[SEEN * SEEN];
static talus_vertex route[4096];

static void must(talus_code code, const talus_error *error) {
  if (code == TALUS_OK) return;
  fprintf(stderr, "%d: %s\n", (int)code, error->text);
  exit(1);
}

static int least(int a, int b) { return a < b ? a : b; }
static int greatest(int a, int b) { return a > b ? a : b; }

static talus_session begin(void) {
  talus_rover rover;
  talus_soil soil;
  talus_options options;
  talus_error error;
  talus_session session = 0;
  const talus_grid grid = {sizeof grid, WIDTH, HEIGHT, 0.5, 0.0, 0.0};
  const talus_layers layers = {sizeof layers, WIDTH * HEIGHT, heights, NULL, NULL, NULL};
  int i;
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
  options.allow_unknown = 1;
  for (i = 0; i < WIDTH * HEIGHT; ++i) heights[i] = NAN; /* not observed */
  must(talus_create(&rover, &soil, 1, &grid, &layers, &options, &session, &error), &error);
  return session;
}

/* Observes 12 m x 12 m of level ground around the rover, with a wall of rock that has a gap in the north. */
static void look(talus_session session, double x_m, double y_m) {
  talus_error error;
  const int column = least(greatest((int)(x_m / 0.5) - SEEN / 2, 0), WIDTH - SEEN);
  const int row = least(greatest((int)(y_m / 0.5) - SEEN / 2, 0), HEIGHT - SEEN);
  const talus_grid window = {sizeof window, SEEN, SEEN, 0.5, 0.5 * column, 0.5 * row};
  const talus_layers layers = {sizeof layers, SEEN * SEEN, seen, NULL, NULL, rocks};
  int c, r;
  for (r = 0; r < SEEN; ++r)
    for (c = 0; c < SEEN; ++c) {
      seen[r * SEEN + c] = 0.0F;
      rocks[r * SEEN + c] = column + c >= 38 && column + c < 41 && row + r < 44;
    }
  must(talus_patch(session, &window, &layers, &error), &error);
}

static void drive(talus_session session, const talus_vertex *at, double time_s) {
  talus_wheel wheels[4];
  talus_error error;
  int i;
  for (i = 0; i < 4; ++i) {
    const double ahead = i < 2 ? 0.45 : -0.45, left = i % 2 == 0 ? 0.4 : -0.4;
    const double c = cos(at->heading_rad), s = sin(at->heading_rad);
    const talus_wheel wheel = {sizeof wheel,      i,    time_s, at->x_m + c * ahead - s * left,
                               at->y_m + s * ahead + c * left, 36.5, 0.04,   NAN,
                               0.01,              0.0,  at->heading_rad, 0.1};
    wheels[i] = wheel;
  }
  must(talus_learn(session, wheels, 4, NULL, &error), &error);
}

int main(void) {
  const talus_session session = begin();
  talus_request request = {sizeof request, 5.0, 10.0, 35.0, 10.0, 0.5};
  talus_summary summary;
  talus_error error;
  int step;
  summary.size = sizeof summary;
  for (step = 0; step < 60; ++step) {
    size_t count, next;
    look(session, request.start_x_m, request.start_y_m);
    must(talus_plan(session, &request, &summary, &error), &error);
    must(talus_read_route(session, 0, route, sizeof route / sizeof *route, &count, &error), &error);
    printf("step %2d at (%4.1f, %4.1f) m, %4.1f m and %5.0f J to go\n", step, request.start_x_m, request.start_y_m,
           summary.length_m, summary.energy_J);
    for (next = 1; next + 1 < count; ++next)
      if (hypot(route[next].x_m - request.start_x_m, route[next].y_m - request.start_y_m) > 3.0) break;
    drive(session, &route[next], 60.0 * (step + 1));
    request.start_x_m = route[next].x_m;
    request.start_y_m = route[next].y_m;
    if (next + 1 >= count) break;
  }
  must(talus_destroy(session, &error), &error);
  return hypot(request.start_x_m - 35.0, request.start_y_m - 10.0) <= 0.5 ? 0 : 1;
}
