// The charts of a report: lines and points over linear or logarithmic axes.
const charts = JSON.parse(document.getElementById("data").textContent);

// The stated ends of an axis, or those of the data with a margin.
function domainOf({low, high, log}, series, place) {
  let least = Infinity, most = -Infinity;
  for (const {values} of series)
    for (const point of values) {
      const value = point[place];
      if (value === null || (log && value <= 0)) continue;
      least = Math.min(least, value);
      most = Math.max(most, value);
    }
  if (!(least <= most)) [least, most] = log ? [0.1, 1] : [0, 1];
  const margin = most > least ? 0.04 * (most - least) : Math.max(0.5, 0.05 * Math.abs(least));
  const [below, above] = log ? [least / 1.2, most * 1.2] : [least - margin, most + margin];
  return [low ?? below, high ?? above];
}

// Series of points differ in shape, too, for readers and printers without colours.
const shapes = ["circle", "cross", "square", "triangle-up", "diamond"];

function seriesMark({name, colour, points, dashed, values}, k) {
  const many = values.length > 400;
  const at = {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}};
  const look = points
    ? {shape: {value: shapes[k % shapes.length]}, fill: {value: dashed ? "#fff" : colour}, stroke: {value: colour}, strokeWidth: {value: dashed ? 2 : 0},
       size: {value: many ? 9 : values.length === 1 ? 90 : 24}, fillOpacity: {value: !many ? 0.85 : k === 0 ? 0.35 : 0.8},
       tooltip: {signal: `'${name.replace(/[\\']/g, "")}: ' + format(datum.x, '.4~g') + ', ' + format(datum.y, '.4~g')`}}
    : {stroke: {value: colour}, strokeWidth: {value: 1.8}, strokeDash: {value: dashed ? [5, 4] : []},
       defined: {signal: "isValid(datum.x) && isValid(datum.y)"}};
  return {type: points ? "symbol" : "line", clip: true, from: {data: "series" + k}, encode: {update: {...at, ...look}}};
}

function chartSpec({title, x, y, series}, width) {
  const named = series.filter(({name}) => name);
  const axis = (orient, scale, {label, log}) => (
    {orient, scale, title: label, titleFontWeight: 400, grid: true, gridColor: "#e4e4e4", tickCount: 6, labelOverlap: true,
     ...(log ? {format: "~g"} : {})});
  const scale = (name, {log}, range, domain) => ({name, type: log ? "log" : "linear", range, domain, zero: false, nice: false});
  return {
    width, height: Math.round(0.5 * width), padding: 4, autosize: {type: "fit-x", contains: "padding"},
    title: {text: title, fontSize: 13, limit: width},
    data: series.map(({values}, k) => ({name: "series" + k, values: values.map(([x, y]) => ({x, y}))})),
    scales: [
      scale("x", x, "width", domainOf(x, series, 0)), scale("y", y, "height", domainOf(y, series, 1)),
      {name: "colour", type: "ordinal", domain: named.map(({name}) => name), range: named.map(({colour}) => colour)},
      {name: "inside", type: "ordinal", domain: named.map(({name}) => name),
       range: named.map(({colour, dashed}) => dashed ? "#fff" : colour)},
      {name: "shape", type: "ordinal", domain: named.map(({name}) => name),
       range: named.map(one => shapes[one.points ? series.indexOf(one) % shapes.length : 0])},
    ],
    axes: [axis("bottom", "x", x), axis("left", "y", y)],
    legends: named.length ? [{fill: "inside", stroke: "colour", shape: "shape", orient: "bottom", columns: width > 360 ? 3 : 2}] : [],
    marks: series.map(seriesMark),
  };
}

function drawCharts() {
  for (const [k, chart] of charts.entries()) {
    const element = document.getElementById("chart" + k);
    const points = chart.series.reduce((sum, {values}) => sum + values.length, 0);
    drawVega(chartSpec(chart, element.clientWidth), element, points > 4000 ? "canvas" : "svg");
  }
}

drawCharts();
let resized = null;
addEventListener("resize", () => { clearTimeout(resized); resized = setTimeout(drawCharts, 200); });
document.documentElement.dataset.state = "ready";
