// The charts of a report: lines and points over linear or logarithmic axes (chart.json).
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
  const spread = Math.max(1.2, Math.sqrt(10 * least / most));  // at least a decade, which has a tick
  const [below, above] = log ? [least / spread, most * spread] : [least - margin, most + margin];
  return [low ?? below, high ?? above];
}

// Series of points differ in shape, too, for readers and printers without colours.
const shapes = ["circle", "cross", "square", "triangle-up", "diamond"];

function styleOf({name, colour, points, dashed, values}, k) {
  const many = values.length > 400;
  return {series: k, name, colour, points, dashed, inside: dashed ? "#fff" : colour,
          shape: shapes[points ? k % shapes.length : 0], size: many ? 9 : values.length === 1 ? 90 : 24,
          opacity: !many ? 0.85 : k === 0 ? 0.35 : 0.8};
}

function chartSpec({title, x, y, series}, width) {
  const styles = series.map(styleOf), named = styles.filter(({name}) => name);
  const values = series.flatMap((one, k) => one.values.map(([x, y]) => ({...styles[k], x, y})));
  const scale = (name, {log}, range, domain) => ({name, type: log ? "log" : "linear", range, domain, zero: false, nice: false});
  const legend = (name, field) => (
    {name, type: "ordinal", domain: named.map(({name}) => name), range: named.map(one => one[field])});
  return {
    ...chartJson, width, height: Math.round(0.5 * width), title: {text: title, fontSize: 13, limit: width},
    signals: [{name: "xTitle", value: x.label}, {name: "yTitle", value: y.label}],
    data: [{name: "points", values: values.filter(({points}) => !points)}, {name: "spots", values: values.filter(({points}) => points)}],
    scales: [scale("x", x, "width", domainOf(x, series, 0)), scale("y", y, "height", domainOf(y, series, 1)),
             legend("colour", "colour"), legend("inside", "inside"), legend("shape", "shape")],
    axes: chartJson.axes.map((axis, k) => [x, y][k].log ? {...axis, format: "~g"} : axis),
    legends: named.length ? [{fill: "inside", stroke: "colour", shape: "shape", orient: "bottom", columns: width > 360 ? 3 : 2}] : [],
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
