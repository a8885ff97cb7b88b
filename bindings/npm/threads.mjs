// Threads: workers that share the memory of the module, and take part in the loops of its calls.
import { wrong } from './calls.mjs';

const inNode = typeof process !== 'undefined' && process.versions?.node !== undefined;
/** Pages have to ask for it, by two headers. */
const canShare = typeof SharedArrayBuffer !== 'undefined' && (inNode || globalThis.crossOriginIsolated === true);
/** Of a helper's stack, in bytes: twice what beltrami.h asks of a thread. */
const STACK = 1 << 20;
/** As WebAssembly writes that a module imports a memory: its names, and what kind of import it is. */
const IMPORT = new TextEncoder().encode('\x03env\x06memory\x02');
/** Beside it: shared, with a most size. */
const SHARED = 3;

/** How many threads there may be: as many as asked for, 0 meaning one for each processor, where memory can be shared. */
export async function threadsFor(asked) {
  if (!Number.isInteger(asked) || asked < 0) throw wrong('threads is to be a whole number: 0 takes one for each processor');
  if (!canShare) return 1;
  if (asked > 0) return asked;
  return inNode ? (await import('node:os')).availableParallelism() : navigator.hardwareConcurrency;
}

/** A copy of the module that says of the memory it imports that it is shared. */
export function withSharedMemory(bytes) {
  const module = new Uint8Array(bytes).slice();
  const at = module.findIndex((_, i) => IMPORT.every((byte, k) => module[i + k] === byte));
  if (at < 0) throw wrong('these bytes are not beltrami.wasm');
  module[at + IMPORT.length] = SHARED;
  return module;
}

/** Starts `count` helpers, and returns what ends them. */
export async function startHelpers(module, memory, c, count) {
  const threads = inNode ? await import('node:worker_threads') : null;
  const workers = [];
  const ready = Array.from({ length: count }, () => new Promise((resolve, reject) => {
    // Bundlers look for these very words.
    const worker = inNode ? new threads.Worker(new URL('./helper.mjs', import.meta.url)) : new Worker(new URL('./helper.mjs', import.meta.url), { type: 'module' });
    workers.push(worker);
    const failed = (error) => reject(new Error(`a thread did not start: ${error.message}`));
    if (inNode) {
      worker.once('message', resolve).once('error', failed);
    } else {
      worker.onmessage = resolve;
      worker.onerror = failed;
    }
    const stack = c.malloc(STACK) >>> 0, tls = c.malloc(c.__tls_size.value) >>> 0;
    if (stack === 0 || tls === 0) throw wrong('there is not enough memory for the threads');
    worker.postMessage({ module, memory, top: stack + STACK, tls });
  }));
  const close = () => {
    c.end_help();
    for (const worker of workers) worker.terminate();
  };
  try {
    await Promise.all(ready);
    if (inNode) for (const worker of workers) worker.unref(); // a program ends without ending its helpers
  } catch (error) {
    close();
    throw error;
  }
  return close;
}
