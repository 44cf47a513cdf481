// The profiles: one panel per quantity over the distance along the route, with a common marker at the
// pointer (profiles.json).
const allPanels = [
  {field: "elevation", title: "elevation [m]", zero: false},
  {field: "slope", title: "slope [deg]", zero: true},
  {field: "slip", title: "slip [-]", zero: true},
  {field: "angle", title: "slip angle [deg]", zero: true},
  {field: "energy", title: "energy [kJ]", zero: true},
  {field: "risk", title: "risk [-]", zero: true},
];
const held = ["slope", "slip", "angle"];  // constant from one vertex to the next

// Minimum and maximum of each section three pixels wide: more points are not visible and slow down drawing.
function thinned(points, field, width) {
  const stretch = points[points.length - 1].s / Math.max(1, width / 3), kept = [];
  for (let from = 0; from < points.length;) {
    let to = from, least = from, most = from;
    const end = (Math.floor(points[from].s / stretch) + 1) * stretch;
    for (; to < points.length && (to === from || points[to].s < end); ++to) {
      if (points[to][field] === null) break;
      if (points[to][field] < points[least][field]) least = to;
      if (points[to][field] > points[most][field]) most = to;
    }
    const chosen = to === from ? [from] : [...new Set([least, most])].sort((a, b) => a - b);
    kept.push(...chosen.map(i => points[i]));
    from = Math.max(to, from + 1);
  }
  if (kept[kept.length - 1] !== points[points.length - 1]) kept.push(points[points.length - 1]);
  return kept;
}

function profileSpec(routes, unit, {panels, step, panelHeight, width}) {
  const values = panels.flatMap((panel, row) => routes.flatMap(({points, colour}, route) =>
    thinned(points, panel.field, width).map(p => (
      {...panel, row, route, colour, d: p.s / unit.metres, value: p[panel.field],
       interpolate: held.includes(panel.field) ? "step-after" : "linear"}))));
  return {...profilesJson, width, height: (panels.length - 1) * step + panelHeight, data: [{name: "points", values}], signals: [
    {name: "step", value: step}, {name: "panelHeight", value: panelHeight},
    {name: "unitTitle", value: `distance along the route [${unit.name}]`},
    {name: "hover", value: null, on: [
      {events: "pointermove, mousemove, touchmove, touchstart", update: "clamp(invert('x', x()), 0, domain('x')[1])"},
    ]},
  ]};
}

// Panels that fit the element: all, or elevation and the quantity that colours the route.
function layoutOf(element, routes) {
  const height = element.clientHeight - 58;
  const chosen = ["slip", "slope", "energy", "risk", "slip"][document.getElementById("quantity").value || 0];
  const known = allPanels.filter(({field}) => routes.some(({points}) => points.some(p => p[field] !== null)));
  const panels = height / known.length >= 44 ? known
    : known.filter(({field}) => field === "elevation" || field === chosen);
  const step = Math.max(44, (height + 17) / panels.length);
  return {panels, step, panelHeight: step - 17, width: Math.max(200, element.clientWidth - 62)};
}

// Returns {mark(s), draw()} of the profiles. Calls onHover(s) when the pointer moves, with s the
// distance from the start [m].
function drawProfiles(element, routes, onHover) {
  const length = Math.max(...routes.map(({points}) => points[points.length - 1].s));
  const unit = length >= 2000 ? {name: "km", metres: 1000} : {name: "m", metres: 1};
  let view = null, quiet = false;
  const draw = () => {
    if (view) view.finalize();
    view = drawVega(profileSpec(routes, unit, layoutOf(element, routes)), element, "svg");
    view.addSignalListener("hover", (_, value) => { if (!quiet) onHover(value * unit.metres); });
  };
  addEventListener("resize", draw);
  document.getElementById("quantity").addEventListener("change", draw);
  return {draw, mark(s) { quiet = true; view.signal("hover", s / unit.metres).run(); quiet = false; }};
}
