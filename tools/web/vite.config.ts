import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One file, so that it works from a disk as from any web server.
export default defineConfig({
  base: "./",
  assetsInclude: ["**/*.gz"],
  plugins: [viteSingleFile()],
  worker: { format: "iife" },
  build: { target: "es2022", assetsInlineLimit: 100_000_000, outDir: "../../build/web", emptyOutDir: false },
});
