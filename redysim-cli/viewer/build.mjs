// Builds `dist/viewer.html`, the page that `redysim animate` and `show` fill with data. With `--check` it says whether the
// committed page is what the sources build, and changes nothing.

import { readFile, writeFile, mkdir } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
const PAGE = path("dist/viewer.html");

const page = await assemble();
if (process.argv.includes("--check")) {
  const committed = await readFile(PAGE, "utf8").catch(() => "");
  if (committed !== page) {
    console.error("viewer/dist/viewer.html is not what the sources build: run `npm run build` and commit it");
    process.exit(1);
  }
  console.log(`dist/viewer.html is what the sources build (${Math.round(page.length / 1000)} kB)`);
} else {
  await mkdir(path("dist"), { recursive: true });
  await writeFile(PAGE, page);
  console.log(`dist/viewer.html: ${Math.round(page.length / 1000)} kB`);
}

async function assemble() {
  const { outputFiles } = await build({
    entryPoints: [path("src/main.js")],
    bundle: true,
    minify: true,
    write: false,
    outdir: path("dist"),
    format: "iife",
    target: "es2022",
    charset: "utf8",
    legalComments: "none",
  });
  const output = (ending) => outputFiles.find((file) => file.path.endsWith(ending)).text.trim();
  const notice = await notices(["three", "uplot"]);
  return fill(await readFile(path("src/page.html"), "utf8"), {
    "/*style*/": output(".css"),
    "/*script*/": `${notice}\n${guarded(output(".js"))}`,
  });
}

/** The licences of what is bundled, as they ask for. */
async function notices(names) {
  const texts = names.map(async (name) => {
    const { version } = JSON.parse(await readFile(path(`node_modules/${name}/package.json`), "utf8"));
    const licence = await readFile(path(`node_modules/${name}/LICENSE`), "utf8");
    return `${name} ${version}\n\n${licence.trim()}`;
  });
  return `/*! Contains:\n\n${(await Promise.all(texts)).join("\n\n")}\n*/`;
}

/** A script that would end its own element would end the page. */
function guarded(script) {
  if (/<\/script|<!--/i.test(script)) throw new Error("the bundle holds `</script` or `<!--`, which HTML would read");
  return script;
}

function fill(template, parts) {
  return Object.entries(parts).reduce((text, [place, part]) => {
    if (text.split(place).length !== 2) throw new Error(`page.html must have ${place} once`);
    return text.replace(place, () => part);
  }, template);
}
