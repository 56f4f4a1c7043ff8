/** `call` at most once in so many ms, the last time always: for what is redrawn while a test runs. */
export function seldom(ms: number, call: () => void): () => void {
  let last = -Infinity;
  let waits = false;
  return () => {
    if (waits) return;
    waits = true;
    setTimeout(() => {
      waits = false;
      last = performance.now();
      call();
    }, Math.max(0, last + ms - performance.now()));
  };
}
