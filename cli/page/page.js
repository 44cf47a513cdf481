// Builds the page from map, profiles and summary.
const canHover = !matchMedia("(hover: none)").matches;

function pointAt(points, s) {
  let low = 0, high = points.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (points[middle].s <= s) low = middle; else high = middle;
  }
  return s - points[low].s < points[high].s - s ? points[low] : points[high];
}

function reading(p) {
  const show = (value, digits, unit) => value === null ? "" : `${value.toFixed(digits)} ${unit}`;
  return [`${show(p.s, 1, "m")} from the start`, `at ${p.x.toFixed(1)}, ${p.y.toFixed(1)}`,
          show(p.elevation, 1, "m elevation"), show(p.slope, 1, "deg slope along"), show(p.across, 1, "deg slope across"),
          p.slip === null ? "" : `slip ${p.slip.toFixed(2)}`, show(p.angle, 1, "deg slip angle"), show(p.energy, 2, "kJ"),
          p.risk === null ? "" : `risk ${p.risk.toPrecision(2)}`, p.category]
    .filter(text => text).join(" · ");
}

function addRow(table, name, values) {
  const row = table.insertRow();
  row.appendChild(document.createElement("th")).textContent = name;
  for (const value of values) row.insertCell().textContent = value;
  row.classList.toggle("warning", name === "warning");
}

function showFacts(data) {
  const comparison = document.getElementById("comparison");
  if (data.comparison.length) addRow(comparison, "what differs", data.routes.map(route => route.name));
  for (const {name, values} of data.comparison) addRow(comparison, name, values);
  for (const [name, value] of data.facts) addRow(document.getElementById("facts"), name, [value]);
  for (const [name, value] of data.provenance) addRow(document.getElementById("provenance"), name, [value]);
}

// Moves the legend and the explained cell into their own area for print, where the legend would hide the route. Returns
// a function that moves both back.
function besideMap() {
  const key = document.getElementById("key"), legend = document.querySelector(".legend"), open = legend.firstChild.open;
  const moved = [legend, ...document.querySelectorAll("#sheet > div")].map(part => [part, part.parentNode]);
  for (const [part] of moved) key.appendChild(part);
  legend.firstChild.open = true;
  return () => {
    for (const [part, place] of moved) place.appendChild(part);
    legend.firstChild.open = open;
  };
}

// Lays out page and map on the screen, on one sheet of paper before printing, and on the screen afterwards.
function layOut(map, data, profiles) {
  let back = null;
  const lay = paper => {
    document.documentElement.classList.toggle("paper", paper);
    if (back) back();
    back = paper ? besideMap() : null;
    map.invalidateSize({animate: false});
    firstView(map, data);
    if (profiles) profiles.draw();
  };
  lay(false);
  let view = null;
  addEventListener("beforeprint", () => {
    view = [map.getCenter(), map.getZoom()];
    lay(true);
  });
  addEventListener("afterprint", () => {
    lay(false);
    if (view) map.setView(...view, {animate: false});
  });
}

function start() {
  const data = JSON.parse(document.getElementById("data").textContent);
  const map = drawMap(document.getElementById("map"), data);
  showFacts(data);
  const explain = probeCells(map, data, offerRuler(map, data));
  offerRelief(data, explain);
  const story = data.story ? showStory(map, data.story) : null;
  const routes = data.routes;
  if (!routes.length || routes.some(({points}) => points.length < 2)) {
    document.getElementById("profiles").hidden = true;
    layOut(map, data, null);
    explain(data.grid.width >> 1, data.grid.height >> 1);
    return;
  }
  const text = document.getElementById("reading");
  text.style.setProperty("--routes", Math.min(routes.length, 3));
  if (story) showLegend("routes", {name: "profiles", legend: routes.map(({colour, name}) => ({colour, label: name}))});
  text.textContent = canHover ? `Hover over the profile${story ? "" : " or a route"}; click a cell of the map.`
    : `Tap the profile${story ? "" : ", a route"} or a cell of the map.`;
  const here = points => {
    const named = (p, k) => p ? (routes[k].name ? `${routes[k].name}: ` : "") + reading(p) : "";
    text.textContent = points.map(named).filter(line => line).join("\n");
    drawn.mark(points);
  };
  // Of a drive, the profiles choose the moment.
  const drawn = story ? {mark: points => story.show(points[0].time)} : drawRoutes(map, data, (k, p) => {
    profiles.mark(p.s);
    here(routes.map((_, i) => i === k ? p : null));
  });
  const charts = document.getElementById("charts");
  const profiles = drawProfiles(charts, routes, s => here(routes.map(({points}) => pointAt(points, s))));
  layOut(map, data, profiles);
}

try {
  start();
  document.documentElement.dataset.state = "ready";
} catch (error) {
  document.documentElement.dataset.state = "failed: " + error.message;
  throw error;
}
