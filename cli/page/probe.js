// Explains a clicked cell, or with Enter the cell at the centre of the map; arrow keys select adjacent cells.
// Layer values are integers in units of the layer's last decimal, stored in RGB of an image; 0 means no
// value.
async function words(uri, width, height) {
  const context = contextOf(width, height);
  context.drawImage(await loaded(uri), 0, 0);
  const bytes = context.getImageData(0, 0, width, height).data;
  return Uint32Array.from({length: width * height}, (_, i) => bytes[4 * i] << 16 | bytes[4 * i + 1] << 8 | bytes[4 * i + 2]);
}

function loaded(uri) {
  return new Promise(done => {
    const image = new Image();
    image.onload = () => done(image);
    image.src = uri;
  });
}

function contextOf(width, height) {
  return Object.assign(document.createElement("canvas"), {width, height}).getContext("2d", {willReadFrequently: true});
}

function valueText(layer, word) {
  if (layer.shares) {
    const all = [word >> 18 & 63, word >> 12 & 63, word >> 6 & 63, word & 63], sum = all.reduce((a, b) => a + b);
    const share = ({label}, i) => all[i] === sum ? label : all[i] ? `${label} ${Math.round(100 * all[i] / sum)} %` : "";
    return layer.legend.map(share).filter(text => text).join(", ");
  }
  if (word === 0) return "no data";
  if (layer.legend) return layer.legend[word - 1 + layer.low].label;
  const value = ((layer.low + word - 1) / 10 ** layer.decimals).toFixed(Math.max(0, layer.decimals));
  return layer.bar.unit ? `${value} ${layer.bar.unit}` : value;
}

// Returns explain(column, row), which creates a table of layer values and a polar chart of cost over heading.
function cellReader(data) {
  const {width, height, cell, cells_per_pixel: block} = data.grid, b = data.bounds;
  let values = null, headings = null;
  return async (column, row) => {
    values = values || Promise.all(data.layers.map(layer => layer.legend || layer.bar ? words(layer.values || layer.shares, width, height) : null));
    headings = headings || readHeadings(data);
    const read = await values, costs = await headings, index = (height - 1 - row) * width + column;
    const table = document.createElement("table"), add = (name, value) => addRow(table, name, [value]);
    data.layers.forEach((layer, i) => { if (read[i]) add(layer.name, valueText(layer, read[i][index])); });
    add("centre", placeText(data, b.west + (column + 0.5) * cell, b.south + (row + 0.5) * cell));
    add("cell", block > 1 ? `mean of ${block} x ${block} cells` : `column ${column}, row ${row}`);
    const parts = [table];
    if (costs) {
      if (block > 1) add("cell in its middle", data.categories[costs.kinds[index] >> 16].label);
      parts.push(drawRose(costs, index));
    }
    const box = document.createElement("div");
    box.append(...parts);
    return box;
  };
}

// Returns explain(column, row), which shows the values of a cell beside the map, or below it on a narrow screen.
function probeCells(map, data, ruler) {
  const {width, height, cell} = data.grid, b = data.bounds;
  const style = {color: "#000", weight: 2, fill: false, interactive: false, className: "chosen"};
  const frame = L.rectangle([[0, 0], [0, 0]], style), read = cellReader(data);
  const sheet = document.getElementById("sheet"), shut = document.createElement("button");
  let chosen = null;
  shut.textContent = "×";
  shut.setAttribute("aria-label", "close");
  shut.addEventListener("click", () => { chosen = null; frame.remove(); sheet.hidden = true; });

  async function explain(column, row) {
    if (column < 0 || row < 0 || column >= width || row >= height) return;
    const west = b.west + column * cell, south = b.south + row * cell;
    sheet.replaceChildren(shut, await read(column, row));
    sheet.hidden = false;
    chosen = {column, row};
    frame.setBounds([[south, west], [south + cell, west + cell]]).addTo(map);
  }
  const at = ({lng, lat}) => explain(Math.floor((lng - b.west) / cell), Math.floor((lat - b.south) / cell));
  map.on("click", ({latlng}) => { if (!ruler.click(latlng)) at(latlng); });
  const steps = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
  map.getContainer().addEventListener("keydown", event => {
    const step = chosen && steps[event.key];
    if (event.key === "Enter" && event.target === map.getContainer()) at(map.getCenter());
    else if (step) explain(chosen.column + step[0], chosen.row + step[1]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }, true);
  return explain;
}
