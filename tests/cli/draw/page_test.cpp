#include <cmath>
#include <regex>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/plot.hpp>
#include <talus/common/common.hpp>

#include "bad_input.hpp"
#include "browser.hpp"
#include "example_scene.hpp"
#include "requirement.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace page_test {

using testing::HasSubstr;
using testing::Not;

/// Returns true if the body of the page without scripts contains the text.
bool bodyHas(const Shown& shown, const std::string& text) {
  return shown.dom.rfind(text, shown.dom.find("id=\"data\"")) != std::string::npos;
}

/// Returns true if the body of the page without scripts matches the regular expression.
bool bodyMatches(const Shown& shown, const std::string& pattern) {
  return std::regex_search(shown.dom.substr(0, shown.dom.find("id=\"data\"")), std::regex(pattern));
}

TEST(Page, PageLoadsNoExternalResource) {
  const std::string html = page(exampleScene());
  for (const char* foreign : {"<link ", "<script src", "@import", "url(http", "sourceMappingURL"})
    EXPECT_EQ(html.find(foreign), std::string::npos) << foreign;
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  keep("page.html", html);
}

TEST(Page, UserTextIsEscaped) {
  Scene scene = exampleScene();
  scene.title = "</script><script>alert(1)</script>";
  scene.facts.emplace_back("file", "</script>@TALUS_TITLE@");
  const std::string html = page(scene);
  EXPECT_THAT(html, Not(HasSubstr("alert(1)</script>")));
  EXPECT_THAT(html, HasSubstr("\\u003c/script>@TALUS_TITLE@"));
}

TEST(Page, MapProfilesAndSummaryAreDrawn) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(page(exampleScene()));
  EXPECT_TRUE(ready(shown)) << shown.console;
  EXPECT_TRUE(bodyHas(shown, "alt=\"hillshade\""));
  EXPECT_TRUE(bodyHas(shown, "alt=\"allowed headings\""));
  EXPECT_TRUE(bodyHas(shown, ">elevation [m]</text>"));
  EXPECT_TRUE(bodyHas(shown, ">distance along the route [m]</text>"));
  EXPECT_TRUE(bodyHas(shown, "<th>energy</th><td>54 kJ (15 Wh)"));
  EXPECT_TRUE(bodyHas(shown, "leaflet-control-scale-line"));
  EXPECT_THAT(shown.console, Not(HasSubstr("CONSOLE"))) << "the page complains";
}

// Property: a name from a file is never interpreted as code or markup, wherever the page shows the name.
TEST(Page, FileNamesAreNeverMarkupOrCode) {
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

TEST(Page, HoveringTheProfileMarksTheMap) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(played(exampleScene(), R"(
    const svg = document.querySelector("#charts svg"), box = svg.getBoundingClientRect();
    svg.dispatchEvent(new MouseEvent("mousemove", {bubbles: true, clientX: box.left + box.width / 2, clientY: box.top + 60}));
    setTimeout(() => document.documentElement.dataset.dots = document.querySelectorAll("path.here").length, 200);)"));
  EXPECT_TRUE(ready(shown)) << shown.console;
  EXPECT_TRUE(bodyHas(shown, "data-dots=\"1\""));
  EXPECT_TRUE(bodyMatches(shown, "id=\"reading\"[^>]*>2[0-9][0-9]\\.[0-9] m from the start"));
}

TEST(Page, HoveringTheRouteMarksTheProfile) {
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

// Plans a route in the folder and returns its page with an appended script that simulates user input.
std::string planned(const Folder& folder, const std::string& script) {
  folder.write("dem.asc", asciiGrid(60, 50, [](int column, int row) {
                 return 1.5 * std::sin(column / 7.0) + 0.9 * std::cos(row / 6.0);
               }));
  const Ran plan = runTalus({"plan", "dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover",
                             "fido", "--start", "3,3", "--goal", "55,45", "--html", "plan.html"},
                            folder.path());
  EXPECT_EQ(plan.code, 0) << plan.err;
  return played(fileContent(folder / "plan.html"), script);
}

// Property: cell values on the page equal those of `talus explain` to the displayed precision; cells are
// selected by Enter and the arrow keys.
TEST(Page, CellValuesEqualThoseOfExplain) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Folder folder;
  const Shown shown = show(planned(folder, R"(
    const map = document.getElementById("map"), root = document.documentElement.dataset;
    const keys = ["Enter", "ArrowRight", "ArrowRight", "ArrowUp", "ArrowUp", "ArrowLeft", "ArrowDown"];
    const press = key => map.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
    const said = [];
    (async () => {
      map.focus();
      for (const key of keys) {
        press(key);
        await new Promise(done => setTimeout(done, 150));
        said.push([...document.querySelectorAll("#sheet tr")].map(row => row.textContent).join("|"));
      }
      root.said = said.join(";");
      document.querySelector("#sheet button").click();
      root.chosen = document.querySelectorAll("path.chosen").length;
    })();)"));
  std::smatch said;
  const std::string body = shown.dom.substr(0, 20000);
  ASSERT_TRUE(std::regex_search(body, said, std::regex("data-said=\"([^\"]*)\""))) << shown.console;
  EXPECT_TRUE(bodyHas(shown, "data-chosen=\"0\""));
  EXPECT_THAT(shown.console, Not(HasSubstr("CONSOLE")));
  const std::regex cell(
      "allowed headings([a-z]+)\\|slope([-0-9.]+) deg\\|[^|0-9]*([-0-9.]+)\\|DP/W standard "
      "deviation([-0-9.]+)"
      "\\|[^|0-9]*([-0-9.]+)\\|elevation([-0-9.]+) m\\|centrex ([-0-9.]+) m, y ([-0-9.]+) m");
  const std::string text = said[1];
  std::set<std::string> places;
  for (std::sregex_iterator it(text.begin(), text.end(), cell), end; it != end; ++it) {
    const std::smatch& m = *it;
    const std::string place = m[7].str() + "," + m[8].str();
    places.insert(place);
    const Ran why = runTalus({"explain", "dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover",
                              "fido", "--at", place, "--json"},
                             folder.path());
    ASSERT_EQ(why.code, 0) << why.err;
    const auto answer = nlohmann::json::parse(why.out);
    const auto cause = [&](const std::string& name, const char* field) {
      for (const auto& one : answer["causes"])
        if (one["name"] == name) return one[field].get<double>();
      return std::nan("");
    };
    // A cell whose worst heading is refused has not all headings.
    EXPECT_FALSE(m[1] == "all" && answer["category"] == "dangerous") << place;
    // Tolerance: half a unit of the last displayed decimal, and rounding to float.
    EXPECT_NEAR(std::stod(m[2]), cause("slope_rad", "value") / kDegree, 0.00501) << place;
    EXPECT_NEAR(std::stod(m[3]), cause("drawbar_pull_over_load", "value"), 0.0000501) << place;
    EXPECT_NEAR(std::stod(m[4]), cause("drawbar_pull_over_load", "std"), 0.0000501) << place;
    EXPECT_NEAR(std::stod(m[5]), cause("sinkage_over_radius", "value"), 0.0000501) << place;
    EXPECT_NEAR(std::stod(m[6]), cause("elevation_m", "value"), 0.00501) << place;
  }
  EXPECT_EQ(places.size(), 7U) << text;
}

TEST(Page, RulerMeasuresDistanceAndBearing) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(played(exampleScene(), R"(
    const map = document.getElementById("map"), box = map.getBoundingClientRect(), root = document.documentElement.dataset;
    const click = (x, y) => map.dispatchEvent(new MouseEvent("click", {bubbles: true, clientX: box.left + x, clientY: box.top + y}));
    const bar = document.querySelector(".leaflet-control-scale-line");
    document.getElementById("ruler").click();
    click(100, 300);
    click(100 + parseFloat(bar.style.width), 300);
    root.measured = document.querySelector(".leaflet-tooltip").textContent + "|" + bar.textContent;
    root.sheet = document.getElementById("sheet").hidden;
    map.dispatchEvent(new KeyboardEvent("keydown", {key: "Escape", bubbles: true}));
    root.left = document.querySelectorAll("path.ruler, .leaflet-tooltip").length;)"));
  std::smatch said;
  const std::string head = shown.dom.substr(0, 2000);
  ASSERT_TRUE(std::regex_search(
      head, said, std::regex("data-measured=\"([0-9.]+) m, last leg 90° from north\\|([0-9]+) m")))
      << head.substr(0, 300) << shown.console;
  // The length of the scale bar agrees with its label to one pixel.
  EXPECT_NEAR(std::stod(said[1]) / std::stod(said[2]), 1.0, 0.03);
  EXPECT_THAT(head, HasSubstr("data-sheet=\"true\""));
}

// Property: on a screen of 1400 x 900 pixels and on a phone, map and profile are visible without scrolling,
// the map covers more than a third of the screen, no mark lies under the north arrow, and on a phone the values
// of a chosen cell stand below the map.
TEST(Page, MapAndProfileFitOneScreen) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  for (const auto& [width, height] : {std::pair{1400, 900}, {390, 844}}) {
    // A Chromium window is at least 500 pixels wide, so a frame emulates the phone.
    const std::string frame =
        "<!doctype html><html data-state='ready'><body style='margin:0'><iframe style='border:0' width=" +
        std::to_string(width) + " height=" + std::to_string(height) + " srcdoc=\"" +
        escaped(played(exampleScene(), R"(
      const of = id => document.getElementById(id).getBoundingClientRect();
      const map = of("map"), charts = document.querySelector("#charts svg").getBoundingClientRect();
      parent.document.body.dataset.fits = map.top >= 0 && charts.top >= 0 && map.bottom <= innerHeight &&
        charts.bottom <= innerHeight + 1 && map.right <= innerWidth && charts.right <= innerWidth &&
        document.documentElement.scrollWidth <= innerWidth;
      parent.document.body.dataset.share = map.width * map.height > innerWidth * innerHeight / 3;
      const north = document.querySelector(".north").getBoundingClientRect();
      const ends = [...document.querySelectorAll(".end")].map(end => end.getBoundingClientRect());
      parent.document.body.dataset.free = ends.every(end => end.right < north.left || end.top > north.bottom);
      document.getElementById("map").dispatchEvent(new MouseEvent("click", {bubbles: true, clientX: 200, clientY: 300}));
      setTimeout(() => parent.document.body.dataset.below = of("sheet").top >= of("map").bottom && of("sheet").height > 200, 300);)")) +
        "\"></iframe></body></html>";
    const Shown shown = show(frame);
    EXPECT_THAT(shown.dom, HasSubstr("data-fits=\"true\"")) << width << shown.console;
    EXPECT_THAT(shown.dom, HasSubstr("data-share=\"true\"")) << width;
    EXPECT_THAT(shown.dom, HasSubstr("data-free=\"true\"")) << width;
    EXPECT_THAT(shown.dom, HasSubstr(width < 800 ? "data-below=\"true\"" : "data-below=\"false\"")) << width;
  }
}

// Property: a varying quantity colours the route in more than one colour, with its unit beside the colour
// bar; the opacity applies to the layer; a selected layer replaces the previous layer.
TEST(Page, QuantityLayerAndOpacityAreSelectable) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(played(exampleScene(), R"(
    const pick = (id, value) => {
      const input = document.getElementById(id);
      input.value = value;
      input.dispatchEvent(new Event(input.type === "range" ? "input" : "change"));
    };
    const seen = [];
    for (let i = 0; i < 5; ++i) {
      pick("quantity", i);
      const colours = new Set([...document.querySelectorAll("path.piece")].map(path => path.getAttribute("stroke")));
      seen.push(document.querySelector("#legend [data-part=route] strong").textContent + " " + (colours.size > 1));
    }
    pick("opacity", 40);
    seen.push(document.querySelector("img[alt='allowed headings']").style.opacity);
    pick("layer", 1);
    seen.push(document.querySelectorAll("img[alt='allowed headings']").length + document.querySelector("#legend [data-part=layer] strong").textContent);
    document.documentElement.dataset.seen = seen.join();)"));
  EXPECT_THAT(
      shown.dom,
      HasSubstr("data-seen=\"route: slip [-] true,route: slope along [deg] true,route: energy [J/m] false,"
                "route: immobilisation risk [1/km] true,route: category true,0.4,0slope [deg]\""))
      << shown.console;
}

// Closed form: interpolated latitude and longitude equal those of the projection, also near the pole.
TEST(Page, CursorShowsLatitudeAndLongitude) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  Scene scene = exampleScene();
  scene.georeference.emplace(
      maps::CoordinateSystem{.name = "polar",
                             .ellipsoid = maps::kMoon,
                             .projection = {.method = maps::ProjectionMethod::PolarStereographic,
                                            .standard_parallel_1_rad = -90.0 * kDegree}});
  const maps::GeoPoint place = scene.georeference->reverse({1237.0, 2211.0});
  const Shown shown = show(played(scene, R"(
    const data = JSON.parse(document.getElementById("data").textContent);
    document.documentElement.dataset.place = placeText(data, 1237, 2211);)"));
  EXPECT_THAT(shown.dom,
              HasSubstr(fmt::format("data-place=\"x 1237.0 m, y 2211.0 m · lat {:.5f}°, lon {:.5f}°\"",
                                    place.latitude_rad / kDegree, place.longitude_rad / kDegree)));
}

// A script that opens the relief view and counts the colours until the drawing has arrived from the graphics process.
constexpr const char* kOpenRelief = R"(
  const root = document.documentElement.dataset, place = document.getElementById("relief");
  document.getElementById("solid").click();
  const timer = setInterval(() => {
    if (!place.dataset.state || (place.dataset.state === "ready" && !place.dataset.drawn)) return;
    root.relief = place.dataset.state + "|" + document.querySelector("#relief p").textContent;
    const shown = place.querySelector("canvas");
    if (!shown) return clearInterval(timer);
    const flat = document.createElement("canvas"), context = flat.getContext("2d");
    flat.width = flat.height = 100;
    context.drawImage(shown, 0, 0, 100, 100);
    const bytes = context.getImageData(0, 0, 100, 100).data, colours = new Set();
    for (let i = 0; i < bytes.length; i += 4) colours.add(bytes[i] << 16 | bytes[i + 1] << 8 | bytes[i + 2]);
    root.colours = colours.size > 100;
    if (colours.size <= 100) return;
    clearInterval(timer);
    const box = shown.getBoundingClientRect();
    const spot = {bubbles: true, clientX: box.left + box.width / 2, clientY: box.top + box.height * 0.55};
    shown.dispatchEvent(new PointerEvent("pointerdown", spot));
    shown.dispatchEvent(new MouseEvent("click", spot));
    const probe = setInterval(() => {
      const text = document.querySelector("#sheet table")?.textContent;
      if (!text) return;
      clearInterval(probe);
      root.probed = text;
    }, 50);
  }, 50);)";

// Property: the relief is not blank, states its vertical exaggeration, and causes no console message.
TEST(Page, ReliefIsDrawn) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  TALUS_REQUIRE(pageTemplate().find("id=\"three\"") != std::string_view::npos,
                "libjs-three was not there at the build");
  // The virtual time of the browser does not wait for its graphics process: on a busy machine it may end
  // before the first drawing.
  Shown shown;
  for (int tries = 0; tries < 3 && shown.dom.find("data-probed") == std::string::npos; ++tries)
    shown =
        show(played(exampleScene(), kOpenRelief),
             "--disable-gpu --enable-unsafe-swiftshader --disable-gpu-watchdog --virtual-time-budget=100000");
  EXPECT_THAT(shown.dom, HasSubstr("data-relief=\"ready|vertical exaggeration 1 ×")) << shown.console;
  EXPECT_THAT(shown.dom, HasSubstr("data-colours=\"true\""));
  EXPECT_TRUE(bodyMatches(shown, "data-probed=\"allowed headings[a-z]+slope[0-9.]+ deg"));
  // Without a graphics card, the driver of Chromium prints a message about reading back the drawing.
  const std::regex driver("[^\n]*GL Driver Message[^\n]*ReadPixels[^\n]*");
  EXPECT_THAT(std::regex_replace(shown.console, driver, ""), Not(HasSubstr("CONSOLE")));
}

TEST(Page, MissingWebGlIsReported) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  TALUS_REQUIRE(pageTemplate().find("id=\"three\"") != std::string_view::npos,
                "libjs-three was not there at the build");
  const Shown shown = show(played(exampleScene(), kOpenRelief), "--disable-gpu --disable-3d-apis");
  EXPECT_THAT(shown.dom, HasSubstr("data-relief=\"no WebGL|No relief: this browser has no WebGL."))
      << shown.console;
}

// Property: before printing, the page is laid out on one A4 sheet within the margins, including the map;
// after printing, the previous layout returns.
TEST(Page, PageFitsOneSheetInPrint) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(played(exampleScene(), R"(
    const size = () => { const b = document.body.getBoundingClientRect(); return `${b.width}x${b.height}`; };
    const before = size();
    dispatchEvent(new Event("beforeprint"));
    const paper = document.body.getBoundingClientRect(), mm = 96 / 25.4, seen = [];
    seen.push(paper.width <= 194 * mm && paper.height <= 281 * mm && document.body.scrollHeight <= 281 * mm);
    for (const id of ["map", "charts", "facts"]) {
      const box = document.getElementById(id).getBoundingClientRect();
      seen.push(box.width > 200 && box.height > 50 && box.bottom <= paper.bottom && box.right <= paper.right + 1);
    }
    dispatchEvent(new Event("afterprint"));
    seen.push(size() === before);
    document.documentElement.dataset.seen = seen.join();)"));
  EXPECT_THAT(shown.dom, HasSubstr("data-seen=\"true,true,true,true,true\"")) << shown.console;
}

// Property: in print, the legend and the explained cell are placed beside the map in full; after printing
// both return to the map.
TEST(Page, PrintsLegendAndCellBesideTheMap) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(played(exampleScene(), R"(
    const map = document.getElementById("map"), at = map.getBoundingClientRect();
    map.dispatchEvent(new MouseEvent("click", {bubbles: true, clientX: at.left + 300, clientY: at.top + 300}));
    const print = () => {
      if (!document.querySelector("#sheet table")) return void setTimeout(print, 50);
      dispatchEvent(new Event("beforeprint"));
      const box = part => document.querySelector(part).getBoundingClientRect(), paper = box("body"), sheet = box("#map");
      const seen = ["#key #legend", "#key table"].map(part => {
        const b = box(part);
        return b.height > 20 && b.top >= sheet.bottom && b.bottom <= box("#profiles").top && b.right <= paper.right;
      });
      seen.push(sheet.height > 300, box("#facts").bottom <= paper.bottom);
      dispatchEvent(new Event("afterprint"));
      seen.push(map.querySelector(".legend #legend") && document.querySelector("#sheet table") ? true : false);
      document.documentElement.dataset.seen = seen.join();
    };
    print();)"));
  EXPECT_THAT(shown.dom, HasSubstr("data-seen=\"true,true,true,true,true\"")) << shown.console;
}

TEST(Page, RoutesAreCompared) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  Scene scene = sceneOf(exampleMap(), {.title = "two"});
  NamedRoute first{"<b>one", exampleRoute(), {}}, second{"two", exampleRoute(), {}};
  for (std::size_t i = 20; i < 40; ++i) second.route.vertices[i].y_m += 40.0;
  second.route.length_m *= 1.1;
  compare(scene, {first, second});
  const Shown shown = show(played(scene, R"(
    const svg = document.querySelector("#charts svg"), box = svg.getBoundingClientRect();
    svg.dispatchEvent(new MouseEvent("mousemove", {bubbles: true, clientX: box.left + box.width / 2, clientY: box.top + 60}));
    setTimeout(() => {
      const rims = new Set([...document.querySelectorAll("path.rim")].map(path => path.getAttribute("stroke")));
      document.documentElement.dataset.seen = [rims.size, document.querySelectorAll("path.here").length,
        document.getElementById("comparison").rows[0].cells[1].textContent,
        document.getElementById("reading").textContent.split("\n").length].join();
    }, 200);)"));
  EXPECT_THAT(shown.dom, HasSubstr("data-seen=\"2,2,&lt;b&gt;one,2\"")) << shown.console;
  EXPECT_THAT(shown.console, Not(HasSubstr("CONSOLE")));
}

TEST(Page, MapWithoutARouteHasNoProfiles) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Shown shown = show(page(sceneOf(exampleMap(), {.title = "map"})));
  EXPECT_TRUE(ready(shown)) << shown.console;
  EXPECT_TRUE(bodyHas(shown, "alt=\"slope\""));
  EXPECT_TRUE(bodyMatches(shown, "id=\"profiles\"[^>]*hidden"));
}

}  // namespace page_test
}  // namespace talus::cli
