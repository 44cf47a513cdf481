// The profiles: one panel per quantity over the distance along the route, with a common marker at the
// pointer.
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

function panelMarks(panel, row, routes, layout) {
  const scale = "y" + row, height = layout.panelHeight;
  return {
    type: "group",
    encode: {update: {y: {value: row * layout.step}, width: {signal: "width"}, height: {value: height},
                      stroke: {value: "#ccc"}}},
    axes: [
      {orient: "left", scale, title: panel.title, tickCount: height > 60 ? 4 : 2, grid: true, gridColor: "#e5e5e5",
       titleFontWeight: 600,       titleAngle: 0, titleAlign: "left", titleX: 0, titleY: -3, titleBaseline: "bottom", titleAnchor: "start"},
      ...(layout.panels.length - 1 === row
        ? [{orient: "bottom", scale: "x", title: {signal: "unitTitle"}, tickCount: 8}] : []),
    ],
    marks: routes.map(({colour}, k) => ({
      type: "line", clip: true, from: {data: panel.field + k}, interactive: false,
      encode: {update: {x: {scale: "x", field: "d"}, y: {scale, field: panel.field}, stroke: {value: colour},
                        strokeWidth: {value: 1.6},
                        interpolate: {value: held.includes(panel.field) ? "step-after" : "linear"},
                        defined: {signal: `isValid(datum['${panel.field}'])`}}},
    })),
  };
}

function profileSpec(routes, unit, layout) {
  const {panels, step, panelHeight} = layout;
  const domain = (data, field) => ({fields: routes.map((_, k) => ({data: data + k, field}))});
  return {
    width: layout.width, height: (panels.length - 1) * step + panelHeight,
    padding: {left: 48, right: 14, top: 16, bottom: 42},
    autosize: "none",
    data: panels.flatMap(({field}) => routes.map(({points}, k) => (
      {name: field + k,
       values: thinned(points, field, layout.width).map(p => ({d: p.s / unit.metres, [field]: p[field]}))}))),
    signals: [
      {name: "unitTitle", value: `distance along the route [${unit.name}]`},
      {name: "hover", value: null, on: [
        {events: "pointermove, mousemove, touchmove, touchstart", update: "clamp(invert('x', x()), 0, domain('x')[1])"},
      ]},
    ],
    scales: [
      {name: "x", type: "linear", domain: domain(panels[0].field, "d"), range: "width", zero: true, nice: false},
      ...panels.map((panel, row) => ({name: "y" + row, type: "linear", range: [panelHeight, 0], nice: true, zero: panel.zero,
                                      domain: domain(panel.field, panel.field)})),
    ],
    marks: [
      ...panels.map((panel, row) => panelMarks(panel, row, routes, layout)),
      {type: "rule", interactive: false, encode: {update: {
        x: {signal: "hover === null ? -1000 : scale('x', hover)"}, y: {value: 0}, y2: {signal: "height"},
        stroke: {value: "#b3202c"}, strokeWidth: {value: 1.2}}}},
    ],
  };
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
