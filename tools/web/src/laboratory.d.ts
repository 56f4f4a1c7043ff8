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
  interface Module {
    Laboratory: new () => Laboratory;
    strength(circles: number[]): Answer;
  }
  export default function create(): Promise<Module>;
}
