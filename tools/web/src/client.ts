/** A laboratory in its worker, as promises. */
import LaboratoryWorker from "./worker?worker&inline";
import { compiled } from "./compiled";
import type { Call, FromWorker, Note } from "./messages";

interface Waiting {
  resolve: (answer: never) => void;
  reject: (error: Error) => void;
  onNote: (note: Note) => void;
}

export class Client {
  private readonly worker = new LaboratoryWorker();
  private readonly waiting = new Map<number, Waiting>();
  private next = 1;

  constructor() {
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      const call = this.waiting.get(data.id);
      if (!call) return;
      if ("note" in data) return call.onNote(data.note);
      this.waiting.delete(data.id);
      if ("error" in data) call.reject(new Error(data.error));
      else call.resolve(data.answer as never);
    };
    compiled().then(
      (module) => this.worker.postMessage({ module }),
      (error: Error) => this.fail(error),
    );
    this.worker.onerror = (event) => this.fail(new Error(event.message));
  }

  ask<Answer>(call: Call, onNote: (note: Note) => void = () => {}): Promise<Answer> {
    const id = this.next++;
    return new Promise<Answer>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (answer: never) => void, reject, onNote });
      this.worker.postMessage({ id, call });
    });
  }

  /** Ends the worker whatever it does; calls under way end as `Stopped`. */
  end() {
    this.worker.terminate();
    this.fail(new Stopped());
  }

  private fail(error: Error) {
    for (const call of this.waiting.values()) call.reject(error);
    this.waiting.clear();
  }
}

export class Stopped extends Error {}
