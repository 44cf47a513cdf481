// Builds the page from map, profiles and summary.
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

function showFacts(facts) {
  const table = document.getElementById("facts");
  for (const [name, value] of facts) {
    const row = table.insertRow();
    row.appendChild(document.createElement("th")).textContent = name;
    row.insertCell().textContent = value;
  }
}

function start() {
  const data = JSON.parse(document.getElementById("data").textContent);
  const map = drawMap(document.getElementById("map"), data);
  showFacts(data.facts);
  probeCells(map, data);
  if (data.story) showStory(map, data.story);
  const points = data.route;
  if (points.length < 2) {
    document.getElementById("profiles").hidden = true;
    return;
  }
  const text = document.getElementById("reading");
  text.textContent = "Hover over the profile or the route; click a cell of the map.";
  const here = p => { text.textContent = reading(p); route.mark(p); };
  const route = drawRoute(map, data, p => { profiles.mark(p.s); here(p); });
  const profiles = drawProfiles(document.getElementById("charts"), points, s => here(pointAt(points, s)));
}

try {
  start();
  document.documentElement.dataset.state = "ready";
} catch (error) {
  document.documentElement.dataset.state = "failed: " + error.message;
  throw error;
}
