/** The form of a set-up: built from the words, filled from a set-up, and read back. */
import { soils } from "./soils";
import { ranges, testsOf, usual, type SetUp } from "./setup";
import { words } from "./words";

type Shown = keyof typeof words.fields;

const number = (key: keyof SetUp, label: Shown) => {
  const [low, high] = ranges[key] ?? [0, 1e9];
  return `<label data-for="${key}">${words.fields[label]}<input name="${key}" type="number" min="${low}" max="${high}" step="any" required></label>`;
};
const options = (names: Record<string, string>) =>
  Object.entries(names)
    .map(([value, name]) => `<option value="${value}">${name}</option>`)
    .join("");

export function formOf(): string {
  const names = Object.fromEntries(Object.entries(soils).map(([key, soil]) => [key, soil.name]));
  return `<form novalidate aria-label="${words.test}">
    <fieldset><legend>${words.soil}</legend>
      <label>${words.fields.preset}<select name="preset">${options(names)}</select></label>
      <p class="soft" id="source"></p>
      ${number("grains", "grains")}
      <label>${words.grading}<select name="grading">${options(words.gradings)}</select></label>
      ${number("smallest", "smallest")}${number("largest", "largest")}
      ${number("d10", "sieve10")}${number("d50", "sieve50")}${number("d60", "sieve60")}
      ${number("friction", "friction")}
      <label>${words.fields.voidRatio}<input name="voidRatio" inputmode="decimal"></label>
      ${number("modulus", "modulus")}
    </fieldset>
    <fieldset><legend>${words.test}</legend>
      <label>${words.fields.test}<select name="test">${options(words.tests)}</select></label>
      <label>${words.fields.pressures}<input name="pressures" inputmode="decimal" required></label>
      ${number("strain", "strain")}${number("seeds", "seeds")}
    </fieldset>
    <div class="run">
      <div class="buttons"><button class="first" type="submit">${words.run}</button>
        <button type="button" id="stop" disabled>${words.stop}</button></div>
      <div id="mistakes" class="wrong" role="alert"></div>
      <p id="status" class="soft" role="status" aria-live="polite">${words.ready}</p>
    </div>
  </form>`;
}

export class SetUpForm {
  /** What has no field: of the soil that was chosen. */
  private kept: Partial<SetUp> = {};

  constructor(private readonly form: HTMLFormElement, onChange: () => void) {
    form.addEventListener("change", (event) => {
      const target = event.target as HTMLInputElement;
      if (target.name === "preset") this.fill({ ...this.read(), ...soils[target.value], preset: target.value });
      this.follow();
      onChange();
    });
  }

  fill(setUp: SetUp) {
    this.kept = setUp;
    for (const [key, value] of Object.entries(setUp)) {
      const field = this.form.elements.namedItem(key) as HTMLInputElement | null;
      if (field) field.value = Array.isArray(value) ? value.join(", ") : String(value);
    }
    this.follow();
  }

  read(): SetUp {
    const setUp: SetUp = { ...usual(), ...this.kept };
    const into = setUp as unknown as Record<string, unknown>;
    for (const [key, value] of new FormData(this.form)) {
      const text = String(value);
      if (key === "pressures") into[key] = text.split(/[,;\s]+/).filter(Boolean).map(Number);
      else into[key] = typeof into[key] === "number" ? (text.trim() === "" ? NaN : Number(text)) : text;
    }
    return setUp;
  }

  /** Shows the fields that count. */
  private follow() {
    const setUp = this.read();
    const { grading, preset, test } = setUp;
    for (const option of this.form.querySelectorAll<HTMLOptionElement>("[name=test] option"))
      option.text = testsOf(setUp)[option.value as SetUp["test"]];
    for (const label of this.form.querySelectorAll<HTMLElement>("[data-for]")) {
      const key = label.dataset.for!;
      const sieve = /^d\d0$/.test(key);
      if (sieve || key === "smallest" || key === "largest") label.hidden = sieve !== (grading === "sieve");
      if (key === "strain") label.hidden = test === "isotropic";
    }
    this.form.querySelector("#source")!.textContent = soils[preset].source;
  }
}
