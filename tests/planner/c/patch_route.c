/* patch_route MAP HEIGHTS CLASSES WEST SOUTH WIDTH HEIGHT RESOLUTION X0 Y0 X1 Y1 ROUTE
 * A rover's program: opens a map, puts a window of new ground into it, as it lies in two files of numbers (float, uint8), plans from
 * X0,Y0 to X1,Y1 and writes the route. Prints and ends as `talus plan` does. */
#include <stdio.h>
#include <stdlib.h>

#include <talus.h>

enum { VERTICES = 65536 };

static int refused(const char *what) {
  fprintf(stderr, "talus: %s\n", what);
  return 2;
}

/* All bytes of a file; NULL where it cannot be read. */
static void *content(const char *path, size_t *bytes) {
  FILE *in = fopen(path, "rb");
  char *all = NULL;
  long size = -1;
  if (in != NULL && fseek(in, 0, SEEK_END) == 0) size = ftell(in);
  if (size >= 0 && fseek(in, 0, SEEK_SET) == 0) all = malloc((size_t)size + 1);
  *bytes = all == NULL ? 0 : fread(all, 1, (size_t)size, in);
  if (in != NULL) fclose(in);
  return all;
}

static int writeRoute(const char *path, talus_session session) {
  static talus_vertex route[VERTICES];
  talus_error error;
  size_t count, i;
  FILE *out;
  if (talus_read_route(session, 0, route, VERTICES, &count, &error) != TALUS_OK) return refused(error.text);
  out = fopen(path, "w");
  if (out == NULL) return refused("the route cannot be written");
  fprintf(out, "{\"type\":\"FeatureCollection\",\"crs\":\"local\",\"features\":[{\"type\":\"Feature\",\"properties\":{},"
               "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[");
  for (i = 0; i < count; ++i) fprintf(out, "%s[%.9g,%.9g]", i ? "," : "", route[i].x_m, route[i].y_m);
  fprintf(out, "]}}]}\n");
  return fclose(out) == 0 ? 0 : refused("the route cannot be written");
}

static int planned(char **words, const float *heights, const uint8_t *classes, size_t cells) {
  talus_options options;
  talus_error error;
  talus_session session = 0;
  talus_code code;
  const talus_grid window = {sizeof window,  atoi(words[6]), atoi(words[7]), atof(words[8]),
                             atof(words[4]), atof(words[5])};
  const talus_layers layers = {sizeof layers, cells, heights, NULL, classes, NULL};
  const talus_request request = {sizeof request, atof(words[9]), atof(words[10]), atof(words[11]), atof(words[12]), 0.0};
  int end = 0;
  talus_default_options(&options);
  code = talus_open(words[1], &options, &session, &error);
  if (code == TALUS_OK) code = talus_patch(session, &window, &layers, &error);
  if (code == TALUS_OK) code = talus_plan(session, &request, NULL, &error);
  if (code == TALUS_OK) end = writeRoute(words[13], session);
  if (code != TALUS_OK) end = code == TALUS_FAILURE ? 3 : refused(error.text);
  if (code == TALUS_NO_ROUTE) end = 1;
  talus_destroy(session, NULL);
  return end;
}

int main(int count, char **words) {
  size_t bytes = 0, cells = 0;
  void *heights, *classes;
  int end;
  if (count != 14) return refused("patch_route MAP HEIGHTS CLASSES WEST SOUTH WIDTH HEIGHT RESOLUTION X0 Y0 X1 Y1 ROUTE");
  heights = content(words[2], &bytes);
  classes = content(words[3], &cells);
  if (heights == NULL || classes == NULL)
    end = refused("heights or classes cannot be read");
  else if (bytes != cells * sizeof(float))
    end = refused("heights and classes differ in number");
  else
    end = planned(words, heights, classes, cells);
  free(heights);
  free(classes);
  return end;
}
