/** One laboratory in a thread of its own: it carries out calls in turn, and tells records and pictures on the way. */
import create, { type Laboratory, type Module } from "../wasm/laboratory.js";
import type { Call, FromWorker, Note, Picture } from "./messages";

type Started = { module: Module; laboratory: Laboratory };
let start: (module: WebAssembly.Module) => void;
const ready = new Promise<WebAssembly.Module>((resolve) => (start = resolve)).then(async (compiled): Promise<Started> => {
  const module = await create({
    instantiateWasm: (imports, done) => {
      void WebAssembly.instantiate(compiled, imports).then((instance) => done(instance, compiled));
      return {};
    },
  });
  return { module, laboratory: new module.Laboratory() };
});
const betweenPictures = 20; // ms

self.onmessage = async (event: MessageEvent<{ id: number; call: Call } | { module: WebAssembly.Module }>) => {
  if ("module" in event.data) return start(event.data.module);
  const { id, call } = event.data;
  const say = (message: FromWorker, moved: Transferable[] = []) => self.postMessage(message, { transfer: moved });
  const note = (told: Note, moved: Transferable[] = []) => say({ id, note: told }, moved);
  try {
    const { module, laboratory } = await ready;
    let rows: Float64Array[] = [];
    let shown = 0;
    const onRecord = (row: Float64Array) => void rows.push(row);
    const onStep = () => {
      const now = performance.now();
      if (now - shown < betweenPictures) return;
      shown = now;
      const picture = laboratory.picture() as unknown as Picture;
      note({ picture }, [picture.cell.buffer, picture.grains.buffer, picture.contacts.buffer]);
      note({ rows });
      rows = [];
    };
    const carryOut = () => {
      switch (call.do) {
        case "pack":
          return laboratory.pack(call.recipe, [], (draw, voidRatio) => note({ draw, voidRatio }));
        case "open":
          return laboratory.open(call.bytes);
        case "run":
          return laboratory.run(call.protocol, [], call.forks, onRecord, onStep);
        case "fork":
          return laboratory.fork(call.from, call.friction, onRecord, onStep);
        case "kept":
          return { kept: laboratory.kept() };
        case "save":
          return laboratory.save();
        case "picture":
          return laboratory.picture();
        case "strain":
          return laboratory.strain(call.xx, call.yy, 0, 0);
        case "envelope":
          return laboratory.envelope(call.length, call.count);
        case "strength":
          return module.strength(call.circles);
      }
    };
    const answer = carryOut() as { error?: string };
    if (rows.length > 0) note({ rows });
    if (answer.error !== undefined) say({ id, error: answer.error });
    else say({ id, answer });
  } catch (error) {
    say({ id, error: error instanceof Error ? error.message : String(error) });
  }
};
