// Unwraps and edits beside the page, which stays quick, and may end this worker to cancel.
import { load } from './beltrami/index.mjs';
import { facesOfCorners } from './corners.mjs';

const loading = load(undefined, { threads: 0 });
/** Milliseconds between two messages of progress. */
const BETWEEN = 50;
/** The chart of a face without area. */
const NO_CHART = 0xffffffff;
let editor = null;
/** Of its corners. */
let faces = null;
/** What `undo` goes back to, the latest last. */
const marks = [];

function reported() {
  let last = 0;
  return (fraction, stage) => {
    if (performance.now() - last < BETWEEN) return;
    last = performance.now();
    postMessage({ fraction, stage });
  };
}

function edited() {
  const { cornerUvs, faceCharts, charts, report } = editor;
  postMessage({ edited: { cornerUvs, faceCharts, charts, report, certificate: editor.check(), undos: marks.length } });
}

/** Maps what an edit concerns, and lays it out among the rest; everything, where that has no room. */
function follow() {
  const ids = () => editor.charts.map(({ id }) => id), before = new Set(ids()), { corners } = editor.update();
  // What was parted and has not moved still wants its margin.
  const { faceCharts } = editor, moved = new Set(ids().filter((id) => !before.has(id)));
  for (const corner of corners) if (faceCharts[faces[corner]] !== NO_CHART) moved.add(faceCharts[faces[corner]]);
  if (moved.size === 0) return;
  try {
    editor.pack(Uint32Array.from(moved));
  } catch (error) {
    if (error.status !== 'BELTRAMI_E_NO_ROOM' && error.status !== 'BELTRAMI_E_INVALID_ARGUMENT') throw error;
    editor.pack();
  }
}

const actions = {
  unwrap(beltrami, { surface, options }) {
    const atlas = beltrami.unwrap(surface, { ...options, progress: reported() });
    postMessage({ atlas, threads: beltrami.threads });
  },
  begin(beltrami, { surface, options }) {
    faces = facesOfCorners(surface);
    editor = beltrami.edit(surface, options);
    editor.update();
    edited();
  },
  seams(_, { open, close }) {
    const mark = editor.save();
    try {
      if (open.length > 0) editor.openSeams(open);
      if (close.length > 0) editor.closeSeams(close);
      follow();
    } catch (error) {
      editor.restore(mark);
      editor.forget(mark);
      throw error;
    }
    marks.push(mark);
    edited();
  },
  undo() {
    const mark = marks.pop();
    editor.restore(mark);
    editor.forget(mark);
    edited();
  },
};

onmessage = async ({ data: { what, ...given } }) => {
  try {
    actions[what](await loading, given);
  } catch (error) {
    postMessage({ failure: error.message, status: error.status ?? '' });
  }
};
