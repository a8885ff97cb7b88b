// What a report says in words. Its keys are those of the program's report; a key that is missing is left out.

const whole = (value) => value.toLocaleString('en-US', { maximumFractionDigits: 0 });
/** Three decimals where they tell something, else four figures. */
export const short = (value) => {
  if (!Number.isFinite(value)) return '∞';
  return Math.abs(value) < 100 ? String(Number(value.toFixed(3))) : String(Number(value.toPrecision(4)));
};
const percent = (share) => `${(100 * share).toFixed(1)} %`;
const counted = (count, one, many) => `${whole(count)} ${count === 1 ? one : many}`;

/** Whether the map is proven, and the words for it. */
export function verdict(report) {
  const found = report.injective;
  if (!found) return { good: false, words: 'not judged' };
  if (found.result) return { good: true, words: 'no flips, no overlaps: proven' };
  const faults = [
    [found.negative, 'flipped triangle', 'flipped triangles'],
    [found.degenerate, 'triangle without area', 'triangles without area'],
    [found.overlaps, 'overlap', 'overlaps'],
  ].filter(([count]) => count > 0).map((fault) => counted(...fault));
  return { good: false, words: `not injective${faults.length ? `: ${faults.join(', ')}` : ''}` };
}

/** Pairs of a name and a value, in the order in which people look for them. */
export function figures(report) {
  const { energy, packing, input = {} } = report, rows = [];
  const row = (name, value, words) => { if (value !== undefined && value !== null) rows.push([name, words(value)]); };
  row('Charts', report.charts, whole);
  row('Triangles', input.triangles, whole);
  row('Mean energy', energy?.symmetric_dirichlet, short);
  row('99 % of the area below', energy?.p99, short);
  row('Greatest energy', energy?.max, short);
  row('Seams / √area', report.seam_over_root_area, short);
  row('Texture used', report.utilisation, percent);
  row('Pages', packing?.pages, (pages) => `${whole(pages)} of ${whole(packing.resolution)}²`);
  row('Margin', packing?.margin, (margin) => `${short(margin)} texels`);
  row('Texels per unit', packing?.texels_per_unit, short);
  row('Time', report.seconds, (seconds) => `${short(seconds)} s`);
  return rows;
}

/** What a chart is, in a line. */
export function aboutChart(chart, energy) {
  const parts = [`Chart ${chart.number + 1}`, `${percent(chart.share)} of the surface`,
    counted(chart.triangles, 'triangle', 'triangles'), `mean energy ${short(chart.energy)}`, `greatest ${short(chart.most)}`];
  if (chart.bad > 0) parts.push(`${counted(chart.bad, 'is', 'are')} flipped or without area`);
  if (energy !== undefined) parts.push(`here ${short(energy)}`);
  return parts.join(' · ');
}
