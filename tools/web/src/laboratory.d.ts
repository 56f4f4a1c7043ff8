declare module "*/laboratory.js" {
  export interface Laboratory {
    pack(recipe: string, settings: string[], onDraw: (draw: number, voidRatio: number) => void): Answer;
    open(bytes: Uint8Array): Answer;
    save(): Answer;
    picture(): Answer;
    run(protocol: string, settings: string[], forks: number, onRecord: (row: Float64Array) => void, onStep: () => void): Answer;
    kept(): Float64Array;
    fork(from: number, friction: number, onRecord: (row: Float64Array) => void, onStep: () => void): Answer;
    strain(xx: number, yy: number, xy: number, yx: number): Answer;
    envelope(length: number, count: number): Answer;
  }
  export type Answer = { error?: string } & Record<string, unknown>;
  export interface Module {
    Laboratory: new () => Laboratory;
    strength(circles: number[]): Answer;
  }
  interface Start {
    /** Called by the module in place of a download; `done` takes what it made. */
    instantiateWasm(imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance, module: WebAssembly.Module) => void): object;
  }
  export default function create(start: Start): Promise<Module>;
}
