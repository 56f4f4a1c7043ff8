/** The WebAssembly of the laboratory: in the page as compressed bytes, compiled once for all workers. */
import address from "../wasm/laboratory.wasm.gz?url";

let once: Promise<WebAssembly.Module> | null = null;

export function compiled(): Promise<WebAssembly.Module> {
  once ??= decompressed().then((bytes) => WebAssembly.compile(bytes));
  return once;
}

/** The address holds the bytes themselves (data:...;base64,...): a page from a file may fetch nothing. */
function decompressed(): Promise<ArrayBuffer> {
  const bytes = Uint8Array.from(atob(address.slice(address.indexOf(",") + 1)), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}
