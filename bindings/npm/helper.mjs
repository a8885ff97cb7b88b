// A worker's life as a thread of the module: threads.mjs starts it.
import { imports } from './system.mjs';

const port = globalThis.postMessage ? null : (await import('node:worker_threads')).parentPort;

async function help({ module, memory, top, tls }) {
  const end = (code) => {
    throw new Error(`the library ended with ${code}`);
  };
  const { exports: c } = await WebAssembly.instantiate(module, imports(memory, () => 0, end));
  c.__stack_pointer.value = top;
  c.__wasm_init_tls(tls);
  (port ?? globalThis).postMessage('ready');
  try {
    c.help();
  } finally {
    c.lose_helper();
  }
}

if (port) port.once('message', help);
else globalThis.onmessage = ({ data }) => help(data);
