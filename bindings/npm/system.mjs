// What the module asks of whoever runs it: a thread's instance of it gets the same as that of the calls.

/** What the C library asks of the system: the time, random numbers, and where a message of its own end goes. */
function system(memory, ended) {
  const view = () => new DataView(memory.buffer);
  const nothing = (count, size) => {
    view().setUint32(count, 0, true);
    view().setUint32(size, 0, true);
    return 0;
  };
  const badDescriptor = () => 8;
  return {
    args_get: () => 0,
    args_sizes_get: nothing,
    environ_get: () => 0,
    environ_sizes_get: nothing,
    clock_time_get: (id, _precision, at) => {
      const milliseconds = id === 0 ? Date.now() : performance.now();
      view().setBigUint64(at, BigInt(Math.round(milliseconds * 1e6)), true);
      return 0;
    },
    fd_close: badDescriptor,
    fd_seek: badDescriptor,
    fd_read: badDescriptor,
    fd_fdstat_get: badDescriptor,
    fd_write: (_descriptor, list, count, written) => {
      let bytes = 0;
      for (let i = 0; i < count; ++i) bytes += view().getUint32(list + 8 * i + 4, true);
      view().setUint32(written, bytes, true);
      return 0;
    },
    random_get: (at, size) => {
      const numbers = crypto.getRandomValues(new Uint8Array(size)); // which takes no shared memory
      new Uint8Array(memory.buffer, at, size).set(numbers);
      return 0;
    },
    sched_yield: () => 0,
    proc_exit: ended,
  };
}

/** The imports of the module. `progress(fraction, stage)`: of a call; `ended(code)`: throws. */
export const imports = (memory, progress, ended) => ({
  env: { memory },
  wasi_snapshot_preview1: system(memory, ended),
  beltrami: { progress },
});
