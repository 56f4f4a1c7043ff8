// The panel of the specimen: what is drawn, the slider, the colours with their numbers, and what a click tells of a grain.
import { columnOf, nearestState, shown, stateOf, withUnit, type Field, type Run, type Section, type State } from "./data";
import { drivingOf } from "./curves";
import { buttons, csvOf, download } from "./download";
import { colour, css } from "./palette";
import { pictureOf, svgOfPicture, type ChainColour, type Draw, type Picture } from "./picture";
import { escaped } from "./svg_plot";
import { Viewer } from "./viewer";

const element = <Name extends keyof HTMLElementTagNameMap = "div">(id: string) => document.getElementById(id) as HTMLElementTagNameMap[Name];

export class Specimen {
  private viewer: Viewer;
  private section!: Section;
  private run!: Run;
  private state?: State;
  private picture?: Picture;
  private field?: Field;
  private playing = 0;
  private readonly slider = element<"input">("slider");
  private readonly quantity = element<"select">("quantity");
  private readonly draws = element<"select">("draw");
  private readonly chains = element<"select">("chains");

  /** `moved`: the reader asks for another record. */
  constructor(private moved: (record: number) => void, private drawn: (state: State) => void) {
    this.viewer = new Viewer(element<"div">("stage"), (viewer) => svgOfPicture(this.picture!, viewer, escaped(this.title())));
    this.slider.addEventListener("input", () => this.moved(this.run.states.states[+this.slider.value].record));
    for (const choice of [this.quantity, this.draws, this.chains]) choice.addEventListener("change", () => this.paint());
    element("reset").addEventListener("click", () => this.viewer.reset());
    element("nearer").addEventListener("click", () => this.viewer.zoom(1.25));
    element("farther").addEventListener("click", () => this.viewer.zoom(0.8));
    element("play").addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    let down = [0, 0];
    element("stage").addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
    element("stage").addEventListener("click", (event) => {
      if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5) this.tell(event);
    });
    element("specimen-downloads").append(buttons(() => `specimen_${this.state?.record ?? 0}`, () => this.grainsAsCsv(),
      () => svgOfPicture(this.picture!, this.viewer, escaped(this.title()))));
    const contacts = document.createElement("button");
    contacts.type = "button";
    contacts.textContent = "contacts as CSV";
    contacts.id = "contacts-csv";
    contacts.addEventListener("click", () => download(`contacts_${this.state?.record ?? 0}.csv`, "text/csv", this.contactsAsCsv()));
    element("specimen-downloads").append(contacts);
  }

  private title() {
    return `${this.run.file}, ${element("where").textContent}`;
  }

  choose(section: Section, run: Run) {
    const keep = this.quantity.value;
    this.stop();
    this.section = section;
    this.run = run;
    this.quantity.replaceChildren(...run.states.fields.map((field) => new Option(withUnit(field.label, field.unit), field.key)), new Option("nothing", ""));
    if (run.states.fields.some((field) => field.key === keep)) this.quantity.value = keep;
    const point = run.states.shape === "point";
    const rocks = run.states.states.some((state) => state.rocks?.length);
    element("chain-choices").hidden = element("contacts-csv").hidden = point;
    element("draw-choice").hidden = point && !rocks;
    const words = point ? ["points and rocks", "points", "rocks"] : ["grains and chains", "grains", "force chains"];
    [...this.draws.options].forEach((option, k) => { option.textContent = words[k]; });
    if (point) this.draws.value = rocks ? "both" : "grains";
    this.slider.max = String(run.states.states.length - 1);
    const several = run.states.states.length > 1;
    element("time").hidden = !several;
    element("kept").textContent = several
      ? `${run.states.states.length} states, ${run.states.states.length < run.found ? `of ${run.found} that were kept (rvelab report --states-MB keeps more)` : "all that were kept"}.`
      : "The end state alone: run the test with --set output.snapshots_every=10 to see it move.";
  }

  /** Shows the state nearest to a record. */
  async show(record: number) {
    const number = nearestState(this.run, record), run = this.run;
    this.slider.value = String(number);
    const packed = run.states.states[number].record, driving = columnOf(run, drivingOf(run));
    const words = driving ? `${driving.label} ${shown(driving.values[packed])} ${driving.unit}` : "";
    element("where").textContent = `${words}, record ${packed}`;
    this.slider.setAttribute("aria-valuetext", words);
    const state = await stateOf(this.section, run, number);
    if (run !== this.run || +this.slider.value !== number) return;
    this.state = state;
    this.paint();
    this.drawn(state);
  }

  paint() {
    if (!this.state) return;
    const draw = this.draws.value as Draw, chainColour = this.chains.value as ChainColour;
    this.field = this.run.states.fields.find((field) => field.key === this.quantity.value);
    this.picture = pictureOf(this.run, this.state, this.field, draw, chainColour);
    this.viewer.show(this.picture, `${this.title()}: ${this.state.n} ${this.run.states.shape}s coloured by ${this.field?.label ?? "nothing"}; arrow keys move the view, + and - zoom, 0 resets`);
    this.scale(draw, chainColour);
    element("stage").dataset.record = String(this.state.record);
  }

  private scale(draw: Draw, chainColour: ChainColour) {
    const box = element("scale");
    box.replaceChildren();
    const bar = (label: string, low: number, high: number, about: boolean) => {
      const strip = document.createElement("span"), line = document.createElement("span");
      strip.className = "strip";
      strip.style.background = `linear-gradient(to right, ${Array.from({ length: 11 }, (_, k) => css(colour(k / 10, about))).join(",")})`;
      line.className = "scale-line";
      const range = document.createElement("span");
      range.className = "range";
      range.append(shown(low), strip, shown(high));
      line.append(label, range);
      box.append(line);
    };
    if (this.field && draw !== "chains") {
      const reach = Math.max(Math.abs(this.field.from), Math.abs(this.field.to));
      bar(withUnit(this.field.label, this.field.unit), this.field.about_zero ? -reach : this.field.from, this.field.about_zero ? reach : this.field.to, this.field.about_zero);
    }
    if (this.state!.rocks.length > 0 && draw !== "grains") {
      const text = document.createElement("span");
      text.textContent = `Grey: ${this.state!.rocks.length} rock${this.state!.rocks.length === 1 ? "" : "s"}, drawn as ${this.state!.dimension === 2 ? "ellipses" : "ellipsoids"} of their half axes.`
        + (draw === "both" && this.state!.dimension === 3 ? " Points are drawn at half of their size." : "");
      box.append(text);
    }
    if (draw !== "grains" && this.state!.contacts > 0) {
      const mean = this.state!.force.reduce((sum, value) => sum + value, 0) / this.state!.contacts;
      if (chainColour === "friction") bar("tangential force over its limit", 0, 1, false);
      const text = document.createElement("span");
      text.textContent = `Width of a chain: normal force, mean ${shown(mean)} N` + (chainColour === "force" ? "; orange: above the mean, grey: below." : ".")
        + (draw === "both" && this.state!.dimension === 3 ? " Grains are drawn at half of their size." : "");
      box.append(text);
    }
  }

  private play() {
    const last = this.run.states.states.length - 1;
    let at = +this.slider.value >= last ? 0 : +this.slider.value;
    element("play").textContent = "pause";
    const every = Math.max(50, Math.min(250, 12000 / last));
    this.playing = window.setInterval(() => {
      this.moved(this.run.states.states[at].record);
      if (at++ >= last) this.stop();
    }, every);
  }
  private stop() {
    clearInterval(this.playing);
    this.playing = 0;
    element("play").textContent = "play";
  }

  private tell(event: MouseEvent) {
    if (!this.picture || !this.state) return;
    const box = element("stage").getBoundingClientRect(), scale = this.viewer.pixelsPerMetre();
    let best = Infinity, found = -1;
    this.picture.rocks.forEach((rock, k) => {
      const [x, y, z] = this.viewer.project(rock[0], rock[1], rock[2]);
      const size = scale * Math.cbrt([3, 6, 9].reduce((product, a) => product * Math.hypot(rock[a], rock[a + 1], rock[a + 2]), 1));
      if (Math.hypot(event.clientX - box.left - x, event.clientY - box.top - y) <= size && z < best) { best = z; found = this.state!.n + k; }
    });
    for (let g = 0; g < this.picture.count; ++g) {
      const [x, y, z] = this.viewer.project(this.picture.position[3 * g], this.picture.position[3 * g + 1], this.picture.position[3 * g + 2]);
      const r = Math.hypot(event.clientX - box.left - x, event.clientY - box.top - y);
      if (r <= scale * this.picture.half[2 * g] && (z < best || (g >= this.state.n && this.state.dimension === 2))) { best = z; found = g; }
    }
    element("told").textContent = found < 0 ? "" : found < this.state.n ? this.grainInWords(found) : this.rockInWords(found - this.state.n);
  }
  private grainInWords(grain: number) {
    const state = this.state!;
    return `${this.run.states.shape === "point" ? "Point" : "Grain"} ${grain}: `
      + this.run.states.fields.map((field) => `${field.label.replace(/,.*| since.*/, "")} ${shown(state.values.get(field.key)![grain])} ${field.unit}`.trim()).join("; ");
  }
  private rockInWords(number: number) {
    const rock = this.state!.rocks[number], flat = this.state!.dimension === 2;
    const half = flat ? rock.slice(3, 5) : [3, 6, 9].map((k) => Math.hypot(rock[k], rock[k + 1], rock[k + 2]));
    return `Rock ${number}: centre at ${rock.slice(0, flat ? 2 : 3).map(shown).join(", ")} m; half axes ${half.map(shown).join(", ")} m`;
  }

  private grainsAsCsv() {
    const state = this.state!, fields = this.run.states.fields;
    return csvOf([["grain", "x (m)", "y (m)", "z (m)", "half length (m)", "other half length (m)", "angle (degrees)",
      ...fields.map((field) => withUnit(field.label, field.unit))],
      ...Array.from({ length: state.n }, (_, g) => [g, state.position[3 * g], state.position[3 * g + 1], state.position[3 * g + 2],
        state.half[2 * g], state.half[2 * g + 1], (state.angle[g] * 180) / Math.PI, ...fields.map((field) => state.values.get(field.key)![g])])]);
  }
  private contactsAsCsv() {
    const state = this.state!;
    return csvOf([["i", "j", "branch x (m)", "branch y (m)", "branch z (m)", "normal force (N)", "tangential force over its limit"],
      ...Array.from({ length: state.contacts }, (_, m) => [state.i[m], state.j[m], state.branch[3 * m], state.branch[3 * m + 1],
        state.branch[3 * m + 2], state.force[m], state.friction[m]])]);
  }
}
