// SPDX-License-Identifier: Apache-2.0
// The gallery: a click on a section's picture opens the section's recording in Rerun's web viewer, one at a time.
// Recordings and viewer lie beside the pages (tools/gallery.py). Without script, WebAssembly or WebGL2 the picture stays.
(() => {
  const here = document.currentScript.src;
  const files = (name) => new URL(`viewer/${name}`, here).href;
  let loaded = null; // the viewer's code, once for the page
  let close = () => {}; // the viewer that is open

  function load() {
    return (loaded ??= start().catch((reason) => {
      loaded = null; // the next click tries again
      throw reason;
    }));
  }

  async function start() {
    await new Promise((done, fail) => {
      const script = Object.assign(document.createElement("script"), { src: files("re_viewer.js"), onload: done });
      script.onerror = () => fail(new Error("the viewer is not on this site"));
      document.head.append(script);
    });
    const answer = await fetch(files("re_viewer_bg.wasm.gz"));
    if (!answer.ok) throw new Error("the viewer is not on this site");
    const unpacked = answer.headers.get("content-encoding") === "gzip"; // by the browser
    const body = unpacked ? answer.body : answer.body.pipeThrough(new DecompressionStream("gzip"));
    const module = new Response(body, { headers: { "content-type": "application/wasm" } });
    await wasm_bindgen({ module_or_path: module });
  }

  function theme() {
    const chosen = document.body.dataset.theme;
    if (chosen === "light" || chosen === "dark") return chosen;
    return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  }

  async function open(swim, recording, say) {
    close();
    say("Loading the viewer, 14 MB the first time ...");
    const found = await fetch(recording, { method: "HEAD" });
    if (!found.ok) throw new Error("the recording is not on this site");
    await load();
    const canvas = document.createElement("canvas");
    swim.classList.add("open");
    swim.prepend(canvas);
    let handle = null, watch = 0;
    close = () => {
      clearInterval(watch);
      close = () => {};
      if (handle) {
        if (!handle.has_panicked()) handle.destroy();
        handle.free();
      }
      canvas.remove();
      swim.classList.remove("open");
      say("");
    };
    const options = { hide_welcome_screen: true, persist: false, enable_history: false, theme: theme() };
    options.on_viewer_event = (text) => swim.dispatchEvent(new CustomEvent("viewer", { detail: JSON.parse(text) }));
    if (swim.dataset.backend) options.render_backend = swim.dataset.backend;
    const made = new wasm_bindgen.WebHandle(options);
    try {
      await made.start(canvas);
    } catch (reason) {
      close();
      throw new Error(`this browser cannot draw it (${reason})`);
    }
    swim.handle = handle = made;
    for (const panel of ["top", "blueprint", "selection"]) handle.override_panel_state(panel, "hidden");
    handle.override_panel_state("time", "collapsed");
    handle.add_receiver(recording);
    say("");
    watch = setInterval(() => {
      if (!handle.has_panicked()) return;
      close();
      say("The viewer has stopped. Reload the page to open it again.");
    }, 1000);
  }

  function button(text, action) {
    const made = Object.assign(document.createElement("button"), { type: "button", textContent: text });
    made.addEventListener("click", action);
    return made;
  }

  for (const picture of document.querySelectorAll("#gallery section img")) {
    const recording = new URL(`recordings/${picture.closest("section").id}.rrd`, location.href).href;
    const swim = Object.assign(document.createElement("div"), { className: "swim" });
    const told = document.createElement("span");
    told.setAttribute("role", "status");
    const say = (text) => (told.textContent = text);
    const show = () => open(swim, recording, say).catch((reason) => say(`No viewer: ${reason.message}.`));
    const whole = button("Full screen", () => swim.querySelector("canvas").requestFullscreen());
    const link = Object.assign(document.createElement("a"), { href: recording, textContent: "Recording", download: "" });
    const bar = document.createElement("div");
    bar.append(button("Open in 3D", show), button("Close", () => close()), whole, link, told);
    picture.replaceWith(swim);
    swim.append(picture, bar);
    picture.addEventListener("click", show);
  }
})();
