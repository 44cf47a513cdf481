// Cost of a cell by heading, interpolated between the nodes of its cost curve as in TravelCurve::price().
const roseHeadings = 36;

// Gradients, cost curves and categories of the cells, and the nodes of all curves; null without cost data.
async function readHeadings({headings, grid}) {
  if (!headings) return null;
  const {image, width, height} = headings.table;
  const [gradients, kinds, nodes] = await Promise.all([words(headings.gradients, grid.width, grid.height),
                                                       words(headings.kinds, grid.width, grid.height),
                                                       words(image, width, height)]);
  return {...headings, gradients, kinds, nodes};
}

// Cost [J/m] in a heading, counter-clockwise from east; null if the heading is refused.
function headingCost({gradients, kinds, nodes, table, most}, index, heading) {
  const curve = kinds[index] & 65535, signed = bits => (bits << 20) >> 20;
  if (curve >= table.curves) return null;
  const dx = signed(gradients[index] >> 12) / 1024, dy = signed(gradients[index] & 4095) / 1024;
  const along = dx * Math.cos(heading) + dy * Math.sin(heading);
  const across = Math.abs(dy * Math.cos(heading) - dx * Math.sin(heading));
  const place = 256 * along + 256 - table.first;
  if (Math.abs(along) > most.along || across > most.across || place < 0 || place > table.bins - 1) return null;
  const between = at => {
    const whole = Math.floor(at + 1e-9);
    return [whole, at - whole > 1e-9 ? at - whole : 0];
  };
  const [bin, binShare] = between(place), [row, rowShare] = between(64 * across);
  const node = (r, b) => {
    const word = nodes[(curve * table.rows + r) * table.bins + b];
    return word ? table.low * Math.exp((word - 1) * table.span) : NaN;
  };
  const inRow = r => node(r, bin) + (binShare ? binShare * (node(r, bin + 1) - node(r, bin)) : 0);
  const cost = inRow(row) + (rowShare ? rowShare * (inRow(row + 1) - inRow(row)) : 0);
  return isNaN(cost) ? null : cost;
}

// Polar chart, east to the right and north up: distance from the centre is the cost; grey sectors are refused
// headings.
function drawRose(read, index) {
  const step = 2 * Math.PI / roseHeadings, angles = Array.from({length: roseHeadings}, (_, k) => k * step);
  const costs = angles.map(heading => headingCost(read, index, heading)), allowed = costs.filter(cost => cost !== null);
  const most = Math.max(...allowed), least = Math.min(...allowed), refused = roseHeadings - allowed.length;
  const at = (heading, radius) => `${(radius * Math.cos(heading)).toFixed(1)} ${(-radius * Math.sin(heading)).toFixed(1)}`;
  const parts = [50, 25].map(r => `<circle r="${r}" fill="none" stroke="#bbb"/>`);
  angles.forEach((heading, k) => {
    const next = (k + 1) % roseHeadings;
    if (costs[k] === null)
      parts.push(`<path class="refused" fill="#d4d4d4" stroke="#777" stroke-width=".8" d="M0 0 L${at(heading - step / 2, 50)} L${at(heading + step / 2, 50)} Z"/>`);
    else if (costs[next] !== null)
      parts.push(`<path stroke="#1b3fbf" stroke-width="3" d="M${at(heading, 50 * costs[k] / most)} L${at(heading + step, 50 * costs[next] / most)}"/>`);
  });
  const figure = document.createElement("figure");
  const caption = allowed.length === 0 ? "every heading is refused"
    : `cost over heading: ${Number(least.toPrecision(3))} to ${Number(most.toPrecision(3))} J/m (rim)` +
      (refused ? `; grey: ${refused} of ${roseHeadings} headings refused` : "; no heading is refused");
  figure.innerHTML = `<svg viewBox="-66 -62 132 124" role="img" aria-label="${caption}">${parts.join("")}` +
    '<text y="-53">N</text><text x="58" y="4">E</text></svg>';
  figure.appendChild(document.createElement("figcaption")).textContent = caption;
  return figure;
}
