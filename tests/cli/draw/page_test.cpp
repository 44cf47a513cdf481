#include <regex>

#include <talus/cli/draw/page.hpp>

#include "example_scene.hpp"
#include "requirement.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace page_test {

using testing::HasSubstr;
using testing::Not;

/// What the browser makes of a page: its DOM after the scripts ran, and what it wrote on its console.
struct Shown {
  std::string dom;
  std::string console;
};

Shown show(const std::string& html) {
  const Folder folder;
  const std::string path = folder.write("page.html", html);
  const std::string line = std::string("HOME='") + folder.path().string() + "' chromium" +
                           " --headless --no-sandbox --disable-gpu --disable-quic --no-first-run"
                           " --disable-background-networking --disable-component-update --disable-sync"
                           " --disable-dev-shm-usage --enable-logging=stderr --virtual-time-budget=4000"
                           " --window-size=1200,900 --user-data-dir='" +
                           (folder / "profile") + "' --dump-dom 'file://" + path + "' >'" + (folder / "dom") +
                           "' 2>'" + (folder / "console") + "'";
  EXPECT_EQ(std::system(line.c_str()), 0);  // NOLINT(cert-env33-c)
  return {fileContent(folder / "dom"), fileContent(folder / "console")};
}

bool ready(const Shown& shown) {
  return shown.dom.find("data-state=\"ready\"") != std::string::npos;
}

/// Whether the page's body, its scripts left out, matches.
bool bodyHas(const Shown& shown, const std::string& text) {
  return shown.dom.rfind(text, shown.dom.find("id=\"data\"")) != std::string::npos;
}

/// The same for a pattern.
bool bodyMatches(const Shown& shown, const std::string& pattern) {
  return std::regex_search(shown.dom.substr(0, shown.dom.find("id=\"data\"")), std::regex(pattern));
}

/// The page with a script behind it that plays the user.
std::string played(const Scene& scene, const std::string& script) {
  std::string html = page(scene);
  return html.insert(html.rfind("</body>"), "<script>" + script + "</script>\n");
}

TEST(Page, NeedsNothingFromElsewhere) {
  const std::string html = page(exampleScene());
  for (const char* foreign : {"<link ", "<script src", "@import", "url(http", "sourceMappingURL"})
    EXPECT_EQ(html.find(foreign), std::string::npos) << foreign;
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  keep("page.html", html);
}

TEST(Page, EscapesWhatTheUserNamed) {
  Scene scene = exampleScene();
  scene.title = "</script><script>alert(1)</script>";
  scene.facts.emplace_back("file", "</script>@TALUS_TITLE@");
  const std::string html = page(scene);
  EXPECT_THAT(html, Not(HasSubstr("alert(1)</script>")));
  EXPECT_THAT(html, HasSubstr("\\u003c/script>@TALUS_TITLE@"));
}

TEST(Page, DrawsMapProfilesAndSummary) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(page(exampleScene()));
  EXPECT_TRUE(ready(shown)) << shown.console;
  EXPECT_TRUE(bodyHas(shown, "alt=\"hillshade\""));
  EXPECT_TRUE(bodyHas(shown, "alt=\"categories\""));
  EXPECT_TRUE(bodyHas(shown, ">elevation [m]</text>"));
  EXPECT_TRUE(bodyHas(shown, ">distance along the route [m]</text>"));
  EXPECT_TRUE(bodyHas(shown, "<th>energy</th><td>54 kJ (15 Wh)"));
  EXPECT_TRUE(bodyHas(shown, "leaflet-control-scale-line"));
  EXPECT_THAT(shown.console, Not(HasSubstr("CONSOLE"))) << "the page complains";
}

// Property: no name from a file is taken for code or for markup, in whichever place of the page it stands.
TEST(Page, NamesFromFilesAreTextInEveryPlace) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  for (const std::string name :
       {"<!--<script>", "</script><script>document.body.dataset.hit=1</script>",
        "<img src=x onerror='document.body.dataset.hit=1'>", "\"'><svg onload=document.body.dataset.hit=1>",
        "@TALUS_DATA@", "\xE2\x80\xA8 ]]> & &lt;"}) {
    Scene scene = exampleScene();
    scene.title = scene.subtitle = name;
    scene.facts.emplace_back(name, name);
    const Shown shown = show(page(scene));
    EXPECT_TRUE(ready(shown)) << name << shown.console;
    EXPECT_FALSE(bodyHas(shown, "data-hit")) << name;
  }
}

TEST(Page, PointingAtTheProfileMarksThePlaceOnTheMap) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(played(exampleScene(), R"(
    const svg = document.querySelector("#charts svg"), box = svg.getBoundingClientRect();
    svg.dispatchEvent(new MouseEvent("mousemove", {bubbles: true, clientX: box.left + box.width / 2, clientY: box.top + 60}));
    setTimeout(() => document.documentElement.dataset.dots = document.querySelectorAll("path.here").length, 200);)"));
  EXPECT_TRUE(ready(shown)) << shown.console;
  EXPECT_TRUE(bodyHas(shown, "data-dots=\"1\""));
  EXPECT_TRUE(bodyMatches(shown, "id=\"reading\"[^>]*>2[0-9][0-9]\\.[0-9] m from the start"));
}

TEST(Page, PointingAtTheRouteMarksTheProfile) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(played(exampleScene(), R"(
    const rule = () => document.querySelector("#charts .mark-rule:last-of-type line").getAttribute("transform");
    const path = document.querySelector("path.leaflet-interactive"), box = path.getBoundingClientRect();
    path.dispatchEvent(new MouseEvent("mousemove", {bubbles: true, clientX: box.left + box.width / 2,
                                                    clientY: box.top + box.height / 2}));
    setTimeout(() => {
      document.documentElement.dataset.reading = document.getElementById("reading").textContent;
      document.documentElement.dataset.rule = rule();
    }, 200);)"));
  EXPECT_TRUE(bodyMatches(shown, "data-reading=\"2[0-9][0-9]\\.[0-9] m from the start")) << shown.console;
  EXPECT_TRUE(bodyMatches(shown, "data-rule=\"translate\\([1-9]"));
}

TEST(Page, OfAMapWithoutARouteHasNoProfiles) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(page(sceneOf(exampleMap(), {.title = "map"})));
  EXPECT_TRUE(ready(shown)) << shown.console;
  EXPECT_TRUE(bodyHas(shown, "alt=\"slope\""));
  EXPECT_TRUE(bodyMatches(shown, "id=\"profiles\"[^>]*hidden"));
}

}  // namespace page_test
}  // namespace talus::cli
