// Makes page.html and sheet.html of src: each one file, with the libraries in it and their licences. `npm ci && node
// build.mjs`; --check compares instead of writing.
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url)), read = (...path) => readFileSync(join(here, ...path), "utf8");
const licenceOf = (name) => {
  const { version } = JSON.parse(read("node_modules", name, "package.json"));
  return `${name} ${version}\n${read("node_modules", name, "LICENSE").trim()}`;
};

// three.js from its sources, without the shaders of its own materials: the viewer has its own, and they are a quarter
// of every page that a report writes.
const ownShadersAlone = {
  name: "own shaders alone",
  setup(build) {
    build.onResolve({ filter: /^three$/ }, () => ({ path: join(here, "node_modules/three/src/Three.js") }));
    build.onLoad({ filter: /ShaderChunk\.js$/ }, () => ({ contents: "export const ShaderChunk = {};" }));
  },
};

async function made(entry, html, libraries) {
  const done = await build({
    absWorkingDir: here, entryPoints: [`src/${entry}`], outfile: "page.js", bundle: true, minify: true, write: false, format: "iife",
    target: ["es2022"], charset: "utf8", legalComments: "none", logLevel: "warning",
    plugins: [ownShadersAlone],
  });
  const output = (end) => done.outputFiles.find((file) => file.path.endsWith(end)).text.trim();
  const script = output(".js").replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
  const licences = libraries.map(licenceOf).join("\n\n");
  return read("src", html).replace("<!--style-->", () => output(".css"))
    .replace("<!--script-->", () => (licences && `/*\n${licences.replaceAll("*/", "* /")}\n*/\n`) + script);
}

const pages = [["page.html", await made("main.ts", "page.html", ["three", "uplot"])], ["sheet.html", await made("sheet.ts", "sheet.html", [])]];
for (const [name, page] of pages) {
  const target = join(here, name);
  if (process.argv.includes("--check")) {
    if (readFileSync(target, "utf8") !== page) {
      console.error(`tools/report/${name} is not what src makes; run tools/report/build and commit it`);
      process.exit(1);
    }
    console.log(`${name} is what src makes`);
  } else {
    writeFileSync(target, page);
    console.log(`${name}: ${(page.length / 1e3).toFixed(0)} kB`);
  }
}
