// The page's controls.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const at = (id) => document.getElementById(id);
  const canvas = at("canvas"), stage = at("stage"), divider = at("divider");
  const state = { tab: 0, view: "picture", ev: Math.round(10 * data.ev100) / 10, curve: "filmic", range: 0.1, average: 1, against: "reference", split: 0.5, flicker: null };
  if (!data.tabs.length) {
    document.querySelector(".viewer").hidden = true;
    return;
  }

  const isDifference = () => state.view === "sigma" || state.view === "relative";
  const picture = () => decodeTab(data.tabs[state.tab]);
  const other = () => (state.against === "authored" && picture().authored ? picture().authored : picture().reference);
  const otherName = () => (other() === picture().authored ? "As authored" : "Mitsuba");

  function draw() {
    const shown = picture(), { width, height } = shown;
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const context = canvas.getContext("2d"), image = context.createImageData(width, height), pixels = image.data;
    if (isDifference()) {
      const blocks = blockMeans(shown, other(), state.average);
      const measure = state.view === "relative"
        ? (b) => (blocks.level[b] > 0 ? blocks.difference[b] / blocks.level[b] / state.range : 0)
        : (b) => (blocks.variance[b] > 0 ? blocks.difference[b] / Math.sqrt(blocks.variance[b]) / sigmaReach : 0);
      drawDifference(pixels, width, height, blocks, state.average, measure);
    } else {
      const split = Math.round(state.split * width);
      const paint = (values, from, to) => state.view === "picture"
        ? drawPicture(pixels, width, height, values, from, to, state.ev, state.curve)
        : drawLuminance(pixels, width, height, values, from, to, state.ev);
      if (state.flicker !== null) paint(state.flicker ? other() : shown.ours, 0, width);
      else { paint(shown.ours, 0, split); paint(other(), split, width); }
    }
    context.putImageData(image, 0, 0);
    stage.classList.toggle("magnified", canvas.clientWidth > 1.5 * width);
    arrange();
    legend();
  }

  // What belongs to the view, and where the divider and the names stand.
  function arrange() {
    const difference = isDifference(), flickering = state.flicker !== null;
    divider.hidden = difference || flickering;
    // The canvas is letterboxed inside the stage when the picture is tall.
    const box = canvas.getBoundingClientRect(), outer = stage.getBoundingClientRect();
    const shownWidth = Math.min(box.width, (box.height * canvas.width) / canvas.height);
    const left = box.left - outer.left + (box.width - shownWidth) / 2;
    divider.style.left = `${left + state.split * shownWidth}px`;
    divider.setAttribute("aria-valuenow", Math.round(100 * state.split));
    at("left-name").hidden = difference || state.flicker === 1;
    at("right-name").hidden = difference || state.flicker === 0;
    at("right-name").textContent = at("read-right-label").textContent = otherName();
    at("exposure-control").hidden = difference;
    at("curve-control").hidden = state.view !== "picture";
    at("range-control").hidden = state.view !== "relative";
    at("average-control").hidden = !difference;
    at("flicker").hidden = difference;
    at("against-control").hidden = !picture().authored;
    at("exposure-value").textContent = `EV ${state.ev.toFixed(1).replace("-", "−")}`;
    canvas.setAttribute("aria-label", difference ? "Difference of the two pictures" : `Ours on the left of the divider, ${otherName()} on the right`);
  }

  function legend() {
    at("legend").hidden = state.view === "picture";
    if (state.view === "picture") return;
    const table = state.view === "luminance" ? brightnessTable : signedTable;
    const bar = at("legend-bar"), context = bar.getContext("2d"), image = context.createImageData(bar.width, 1);
    for (let x = 0; x < bar.width; ++x) {
      const i = 3 * Math.round((255 * x) / (bar.width - 1));
      image.data.set([table[i], table[i + 1], table[i + 2], 255], 4 * x);
    }
    context.putImageData(image, 0, 0);
    const labels = {
      luminance: () => [-5, -2.5, 0, 2.5, 5].map((stops) => `${readable(Number((middleLuminance(state.ev) * 2 ** stops).toPrecision(2)))} cd/m²`),
      sigma: () => ["−4 σ, ours darker", "−2", "0", "+2", "+4 σ, ours brighter"],
      relative: () => [-1, -0.5, 0, 0.5, 1].map((part) => `${part > 0 ? "+" : ""}${readable(100 * part * state.range)} %`),
    }[state.view]();
    at("legend-ticks").replaceChildren(...labels.map((label, i) => {
      const tick = document.createElement("span");
      tick.textContent = label;
      tick.style.left = `${(100 * i) / (labels.length - 1)}%`;
      return tick;
    }));
    at("legend-text").textContent = {
      luminance: "Luminance, five stops to each side of middle grey at the exposure chosen.",
      sigma: "Difference over the standard deviation of the noise: grain without pattern is noise, a pattern is a difference. Averaging brings out what is small.",
      relative: "Difference over Mitsuba’s luminance. Averaging makes noise smaller and leaves differences as they are.",
    }[state.view];
  }

  let queued = false;
  function redraw() {
    if (queued) return;
    queued = true;
    requestAnimationFrame(() => { queued = false; draw(); });
  }

  function select(index, focus) {
    state.tab = (index + data.tabs.length) % data.tabs.length;
    for (const [i, button] of [...at("tabs").children].entries()) {
      button.setAttribute("aria-selected", i === state.tab);
      button.tabIndex = i === state.tab ? 0 : -1;
      if (focus && i === state.tab) button.focus();
    }
    redraw();
  }
  at("tabs").replaceChildren(...data.tabs.map((tab, i) => {
    const button = document.createElement("button");
    button.type = "button";
    button.setAttribute("role", "tab");
    button.className = tab.verdict;
    button.textContent = tab.name;
    button.title = [tab.description, { same: "agrees", differs: "differs", undecided: "undecided" }[tab.verdict]].filter(Boolean).join(": ");
    button.addEventListener("click", () => select(i, false));
    return button;
  }));
  at("tabs").addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (step) select(state.tab + step, true);
  });

  const bind = (id, key, convert) => at(id).addEventListener("input", (event) => { state[key] = convert(event.target.value); redraw(); });
  bind("exposure", "ev", Number);
  bind("curve", "curve", String);
  bind("range", "range", Number);
  bind("average", "average", Number);
  bind("against", "against", String);
  at("views").addEventListener("change", (event) => { state.view = event.target.value; stopFlicker(); redraw(); });
  at("exposure").min = Math.floor(state.ev - 10);
  at("exposure").max = Math.ceil(state.ev + 10);
  at("exposure").value = state.ev;

  // One press shows the two in turn until the next; who prefers no motion turns them by hand.
  let timer = 0;
  function stopFlicker() {
    clearInterval(timer);
    state.flicker = null;
    at("flicker").setAttribute("aria-pressed", "false");
  }
  function flicker() {
    if (isDifference()) return;
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (still ? state.flicker === 1 : state.flicker !== null) stopFlicker();
    else {
      state.flicker = state.flicker === null ? 0 : 1;
      at("flicker").setAttribute("aria-pressed", "true");
      if (!still) timer = setInterval(() => { state.flicker = 1 - state.flicker; redraw(); }, 600);
    }
    redraw();
  }
  at("flicker").addEventListener("click", flicker);
  document.addEventListener("keydown", (event) => {
    if (event.key.toLowerCase() === "f" && !event.ctrlKey && !event.metaKey && !event.altKey && event.target.tagName !== "SELECT") flicker();
  });

  // Where on the picture the pointer is, in [0, 1).
  function place(event) {
    const box = canvas.getBoundingClientRect();
    const scale = Math.min(box.width / canvas.width, box.height / canvas.height);
    const x = (event.clientX - box.left - (box.width - scale * canvas.width) / 2) / (scale * canvas.width);
    const y = (event.clientY - box.top - (box.height - scale * canvas.height) / 2) / (scale * canvas.height);
    return [x, y];
  }
  function move(split) { state.split = Math.min(1, Math.max(0, split)); redraw(); }
  let dragging = false;
  stage.addEventListener("pointerdown", (event) => {
    if (isDifference() || state.flicker !== null) return;
    dragging = true;
    stage.setPointerCapture(event.pointerId);
    move(place(event)[0]);
  });
  stage.addEventListener("pointerup", () => { dragging = false; });
  stage.addEventListener("pointercancel", () => { dragging = false; });
  stage.addEventListener("pointermove", (event) => {
    const [x, y] = place(event);
    if (dragging) move(x);
    read(Math.floor(x * canvas.width), Math.floor(y * canvas.height));
  });
  divider.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    move(state.split + step);
  });

  function read(x, y) {
    const shown = picture();
    if (x < 0 || y < 0 || x >= shown.width || y >= shown.height) return;
    const p = y * shown.width + x, values = other();
    const ours = luminanceAt(shown.ours, p), theirs = luminanceAt(values, p), sigma = shown.sigma[p];
    const difference = values === shown.reference ? luminanceAt(shown.difference, p) : ours - theirs;
    const triple = (from) => `${readable(luminanceAt(from, p))} cd/m²`;
    const bin = data.tabs[state.tab].bin;
    at("read-pixel").textContent = bin > 1 ? `${x * bin}, ${y * bin} (mean of ${bin} × ${bin})` : `${x}, ${y}`;
    at("read-ours").textContent = triple(shown.ours);
    at("read-reference").textContent = triple(values);
    at("read-difference").textContent = theirs > 0 ? `${difference > 0 ? "+" : ""}${readable(Number((100 * difference / theirs).toPrecision(3)))} %` : `${readable(difference)} cd/m²`;
    at("read-sigma").textContent = values === shown.reference && sigma > 0 ? `${difference > 0 ? "+" : ""}${readable(Number((difference / sigma).toPrecision(3)))} σ` : "–";
  }

  addEventListener("resize", redraw);
  select(0, false);
  draw();
})();
