// The profiles: one panel per quantity over the distance along the route, with one common rule at the pointer.
const panels = [
  {field: "elevation", title: "elevation [m]", zero: false},
  {field: "slope", title: "slope along [deg]", zero: true},
  {field: "slip", title: "slip [-]", zero: true},
  {field: "angle", title: "slip angle [deg]", zero: true},
  {field: "energy", title: "energy [kJ]", zero: true},
];
const panelHeight = 92, panelStep = 118;

function panelMarks(panel, row) {
  const scale = "y" + row;
  return {
    type: "group",
    encode: {update: {y: {value: row * panelStep}, width: {signal: "width"}, height: {value: panelHeight},
                      stroke: {value: "#ccc"}}},
    axes: [
      {orient: "left", scale, title: panel.title, tickCount: 4, grid: true, gridColor: "#eee", titleFontWeight: 500,
       titleX: -46, titleY: panelHeight / 2, titleAnchor: "middle"},
      ...(row === panels.length - 1 ? [{orient: "bottom", scale: "x", title: {signal: "unitTitle"}, tickCount: 8}] : []),
    ],
    marks: [
      {type: "line", clip: true, from: {data: "route"}, interactive: false,
       encode: {update: {x: {scale: "x", field: "d"}, y: {scale, field: panel.field}, stroke: {value: "#1b3fbf"},
                         strokeWidth: {value: 1.6},
                         interpolate: {value: ["slope", "slip", "angle"].includes(panel.field) ? "step-after" : "linear"},
                         defined: {signal: `isValid(datum['${panel.field}'])`}}}},
    ],
  };
}

function profileSpec(points, unit) {
  return {
    width: 600, height: (panels.length - 1) * panelStep + panelHeight, padding: {left: 62, right: 14, top: 6, bottom: 42},
    autosize: "none",
    data: [{name: "route", values: points.map(p => ({...p, d: p.s / unit.metres}))}],
    signals: [
      {name: "unitTitle", value: `distance along the route [${unit.name}]`},
      {name: "hover", value: null, on: [
        {events: "pointermove, mousemove, touchmove, touchstart", update: "clamp(invert('x', x()), 0, domain('x')[1])"},
      ]},
    ],
    scales: [
      {name: "x", type: "linear", domain: {data: "route", field: "d"}, range: "width", zero: true, nice: false},
      ...panels.map((panel, row) => ({name: "y" + row, type: "linear", range: [panelHeight, 0], nice: true, zero: panel.zero,
                                      domain: {data: "route", field: panel.field}})),
    ],
    marks: [
      ...panels.map(panelMarks),
      {type: "rule", interactive: false, encode: {update: {
        x: {signal: "hover === null ? -1000 : scale('x', hover)"}, y: {value: 0}, y2: {signal: "height"},
        stroke: {value: "#b3202c"}, strokeWidth: {value: 1.2}}}},
    ],
  };
}

// Draws the profiles and returns {mark(s)}; calls onHover(s) when the pointer moves; s in metres from the start.
function drawProfiles(element, points, onHover) {
  const need = name => vegaModules["vega-" + name];
  for (const kind of ["transforms", "view-transforms", "encode"]) Object.assign(need("dataflow").transforms, need(kind));
  const length = points[points.length - 1].s;
  const unit = length >= 2000 ? {name: "km", metres: 1000} : {name: "m", metres: 1};
  const view = new (need("view").View)(need("parser").parse(profileSpec(points, unit)),
                                       {renderer: "svg", container: element, hover: false});
  const resize = () => view.width(Math.max(200, element.clientWidth - 76)).resize().run();
  resize();
  addEventListener("resize", resize);
  let quiet = false;
  view.addSignalListener("hover", (_, value) => { if (!quiet) onHover(value * unit.metres); });
  return {mark(s) { quiet = true; view.signal("hover", s / unit.metres).run(); quiet = false; }};
}
