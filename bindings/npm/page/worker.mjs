// Unwraps beside the page, which stays quick, and may end this worker to cancel.
import { load } from '../beltrami/index.mjs';

const loading = load();
/** Milliseconds between two messages of progress. */
const BETWEEN = 50;

onmessage = async ({ data: { surface, options } }) => {
  try {
    const beltrami = await loading;
    let last = 0;
    const progress = (fraction, stage) => {
      if (performance.now() - last < BETWEEN) return;
      last = performance.now();
      postMessage({ fraction, stage });
    };
    const atlas = beltrami.unwrap(surface, { ...options, progress });
    postMessage({ atlas, version: beltrami.version });
  } catch (error) {
    postMessage({ failure: error.message, status: error.status ?? '' });
  }
};
