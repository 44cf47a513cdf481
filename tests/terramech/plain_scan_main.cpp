// Applies the plain scan to a table: plain_scan T.csv BASE.yaml. Prints one column a line.
#include <cstdio>

#include <talus/terramech/terramech_io.hpp>

#include "plain_scan.hpp"

int main(int argc, char** argv) {
  using namespace talus::terramech;
  if (argc < 3) return 2;
  const ModelFile base = loadModel(argv[2]);
  const Trial trial = makeTrial(readTelemetry(argv[1], {.required = {"load_N", "slip"}}), base.model);
  for (const std::string& column : plainScan(base.model, trial, !base.soil_given))
    std::printf("%s\n", column.c_str());
}
