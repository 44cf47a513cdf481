#include "browser.hpp"

#include <cstdlib>

#include <talus/cli/draw/page.hpp>

#include "bad_input.hpp"
#include "requirement.hpp"
#include "run_program.hpp"

namespace talus::cli {

Shown show(const std::string& html, const std::string& graphics) {
  const Folder folder;
  const std::string path = folder.write("page.html", html);
  const std::string line = std::string("HOME='") + folder.path().string() + "' chromium" +
                           " --headless --no-sandbox --disable-quic --no-first-run"
                           " --disable-background-networking --disable-component-update --disable-sync"
                           " --disable-dev-shm-usage --enable-logging=stderr --virtual-time-budget=4000"
                           " --window-size=1200,900 " +
                           graphics + " --user-data-dir='" + (folder / "profile") + "' --dump-dom 'file://" +
                           path + "' >'" + (folder / "dom") + "' 2>'" + (folder / "console") + "'";
  EXPECT_EQ(std::system(line.c_str()), 0);  // NOLINT(cert-env33-c)
  return {fileContent(folder / "dom"), fileContent(folder / "console")};
}

bool ready(const Shown& shown) {
  return shown.dom.find("data-state=\"ready\"") != std::string::npos;
}

std::string played(std::string html, const std::string& script) {
  return html.insert(html.rfind("</body>"), "<script>" + script + "</script>\n");
}

std::string played(const Scene& scene, const std::string& script) {
  return played(page(scene), script);
}

}  // namespace talus::cli
