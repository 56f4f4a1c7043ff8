/** The pad on which a specimen is strained by hand. */
import type { Client } from "./client";
import { words } from "./words";

/** Strain of the whole width of the pad, and the longest step: dragged far, the path is cut. */
const fullWidth = 0.04;
const arrowStep = 2e-4;
const longestStep = 2e-4;

export class ProbePad {
  private at = { x: 0, y: 0 };
  private wanted = { x: 0, y: 0 };
  private busy = false;
  private client: Client | null = null;
  private readonly point: HTMLElement;
  onAnswer: (xx: number, yy: number, ms: number) => void = () => {};
  onError: (error: unknown) => void = () => {};

  constructor(pad: HTMLElement) {
    this.point = document.createElement("span");
    pad.append(this.point);
    pad.setAttribute("aria-label", words.probePad);
    const drag = (event: PointerEvent) => {
      if (event.buttons === 0) return;
      const box = pad.getBoundingClientRect();
      const share = (value: number) => Math.min(1, Math.max(0, value)) - 0.5;
      this.go(fullWidth * share((event.clientX - box.left) / box.width), -fullWidth * share((event.clientY - box.top) / box.height));
    };
    pad.addEventListener("pointerdown", (event) => {
      pad.setPointerCapture(event.pointerId);
      drag(event);
    });
    pad.addEventListener("pointermove", drag);
    pad.addEventListener("keydown", (event) => {
      const steps: Record<string, [number, number]> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
      const step = steps[event.key];
      if (!step) return;
      event.preventDefault();
      this.go(this.wanted.x + arrowStep * step[0], this.wanted.y + arrowStep * step[1]);
    });
    this.place();
  }

  /** The specimen of this laboratory from now on, unstrained; none: the pad waits. */
  use(client: Client | null) {
    this.client = client;
    this.at = { x: 0, y: 0 };
    this.wanted = { x: 0, y: 0 };
    this.place();
  }

  private place() {
    this.point.style.left = `${50 + (100 * this.wanted.x) / fullWidth}%`;
    this.point.style.top = `${50 - (100 * this.wanted.y) / fullWidth}%`;
  }

  private async go(x: number, y: number) {
    if (!this.client) return;
    const half = fullWidth / 2;
    this.wanted = { x: Math.max(-half, Math.min(half, x)), y: Math.max(-half, Math.min(half, y)) };
    this.place();
    if (this.busy) return;
    this.busy = true;
    try {
      while (this.client && (this.at.x !== this.wanted.x || this.at.y !== this.wanted.y)) {
        const target = { ...this.wanted };
        const way = { x: target.x - this.at.x, y: target.y - this.at.y };
        const length = Math.hypot(way.x, way.y);
        const share = Math.min(1, longestStep / length);
        const [xx, yy] = [way.x * share, way.y * share];
        const begin = performance.now();
        const { stress } = await this.client.ask<{ stress: Float64Array }>({ do: "strain", xx, yy });
        this.at = share === 1 ? target : { x: this.at.x + xx, y: this.at.y + yy };
        this.onAnswer(-stress[0] / 1e3, -stress[1] / 1e3, performance.now() - begin);
      }
    } catch (error) {
      this.wanted = { ...this.at };
      this.place();
      this.onError(error);
    } finally {
      this.busy = false;
    }
  }
}

/** A response envelope: changes of stress (kPa, compression positive), as a closed line. */
export function drawEnvelope(place: HTMLElement, changes: Float64Array) {
  const points = Array.from({ length: changes.length / 2 }, (_, k) => [-changes[2 * k] / 1e3, changes[2 * k + 1] / 1e3]);
  const largest = 1.1 * Math.max(...points.map(([x, y]) => Math.hypot(x, y)));
  const line = points.map(([x, y]) => `${((100 * x) / largest).toFixed(2)},${((100 * y) / largest).toFixed(2)}`).join(" ");
  place.innerHTML = `<svg viewBox="-110 -110 220 220" role="img" aria-label="${words.envelope}">
    <path d="M-105 0H105M0 -105V105" stroke="var(--line)"/>
    <polygon points="${line}" fill="none" stroke="#0072b2" stroke-width="2"/>
    <text x="105" y="14" text-anchor="end">Δσ_xx</text><text x="4" y="-98">Δσ_yy, ± ${largest.toPrecision(2)} kPa</text></svg>`;
}
