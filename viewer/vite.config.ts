import { defineConfig, type Plugin } from "vite";

/** Puts the one script and the one style sheet into the page, so that `dist/report.html` needs no other file. */
function singleFile(): Plugin {
  return {
    name: "single-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle["report.html"];
      if (page?.type !== "asset") throw new Error("report.html is missing from the bundle");
      let html = String(page.source);
      for (const [name, file] of Object.entries(bundle)) {
        if (file.type === "chunk") {
          const code = file.code.replaceAll("</script", "<\\/script");
          const tag = new RegExp(`<script[^>]*src="[^"]*${name}"[^>]*></script>`);
          if (!tag.test(html)) throw new Error(`no script tag asks for ${name}`);
          html = html.replace(tag, "");
          html = html.replace("</body>", () => `<script type="module">${code}</script>\n</body>`);
          delete bundle[name];
        } else if (name.endsWith(".css")) {
          const tag = new RegExp(`<link[^>]*href="[^"]*${name}"[^>]*>`);
          if (!tag.test(html)) throw new Error(`no link asks for ${name}`);
          html = html.replace(tag, () => `<style>${file.source}</style>`);
          delete bundle[name];
        } else if (name !== "report.html") {
          throw new Error(`${name} would stay a file of its own`);
        }
      }
      page.source = html;
    },
  };
}

export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 1 << 20,
    chunkSizeWarningLimit: 2000,
    rollupOptions: { input: "report.html", output: { inlineDynamicImports: true } },
  },
  plugins: [singleFile()],
});
