#include <talus/cli/ground/site_description.hpp>
#include <talus/common/input_error.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace site_description_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

maps::SiteOptions loaded(const std::string& text) {
  const Folder folder;
  return loadSite(folder.write("site.yaml", text));
}

TEST(SiteDescription, KindsAreFoundByName) {
  EXPECT_EQ(siteKind("craters"), maps::SiteKind::Craters);
  EXPECT_EQ(siteKind("dunes"), maps::SiteKind::Dunes);
  EXPECT_EQ(siteKind("rocks"), maps::SiteKind::Rocks);
  EXPECT_THAT([] { siteKind("crater"); }, ThrowsMessage<InputError>(HasSubstr("did you mean 'craters'?")));
  EXPECT_THAT([] { siteKind("lake"); },
              ThrowsMessage<InputError>(HasSubstr("choose craters, dunes or rocks")));
}

TEST(SiteDescription, OmittedFieldsAreDefaultsAndWidthImpliesASquare) {
  const auto site = loaded("site: {kind: dunes, width: 64, resolution_cm: 50, seed: 9}\n");
  EXPECT_EQ(site.kind, maps::SiteKind::Dunes);
  EXPECT_EQ(site.width, 64);
  EXPECT_EQ(site.height, 64);
  EXPECT_EQ(site.resolution_m, 0.5);
  EXPECT_EQ(site.seed, 9U);
  const maps::SiteOptions defaults;
  EXPECT_EQ(loaded("site: {kind: rocks}\n").resolution_m, defaults.resolution_m);
  EXPECT_EQ(loaded("site: {kind: rocks, width: 8, height: 5}\n").height, 5);
}

TEST(SiteDescription, ErrorsNameFileAndField) {
  EXPECT_THAT([] { loaded("site: {kind: dunes, seed: -1}\n"); },
              ThrowsMessage<InputError>(HasSubstr("seed = -1")));
  EXPECT_THAT([] { loaded("site: {kind: dunes, widht: 3}\n"); },
              ThrowsMessage<InputError>(HasSubstr("width")));
  EXPECT_THAT([] { loaded("kind: dunes\n"); }, ThrowsMessage<InputError>(HasSubstr("site.yaml:1")));
  EXPECT_THROW(loaded("site: {width: 8}\n"), InputError);
}

}  // namespace site_description_test
}  // namespace talus::cli
