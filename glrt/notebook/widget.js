// A live picture: a canvas, sliders with their costs, and the figures of the render.
//
// The page asks for a picture when it has got the one before, and sends the input since then along
// with the question. So a slow kernel or page gets fewer pictures, and a closed page gets none.

const STEPS = 1000; // of a slider
const PATIENCE = 5000; // milliseconds without a reply after which input asks again
const KEYS = { ArrowLeft: [-0.04, 0], ArrowRight: [0.04, 0], ArrowUp: [0, -0.04], ArrowDown: [0, 0.04] };
const CLICKS = { "+": 1, "=": 1, "-": -1 };
const LINE = 100; // pixels of scrolling in a click of the wheel
const HINT = "Drag or arrow keys: turn. Wheel after a click, or + and -: nearer or farther. Double click: first view.";

const nothing = () => ({ turn: [0, 0], wheel: 0, home: false, settings: {}, lights: {} });

function made(parent, tag, className = "", text = "") {
  const node = document.createElement(tag);
  if (className) node.className = className;
  node.textContent = text;
  parent.append(node);
  return node;
}

/** A slider for a row of the kernel; `changed` gets its key and new value. */
class Slider {
  constructor(parent, row, changed) {
    this.row = row;
    const label = made(parent, "label", "", row.label);
    label.title = row.help;
    this.input = made(parent, "input");
    Object.assign(this.input, { type: "range", min: 0, max: STEPS, step: 1, title: row.help });
    this.input.setAttribute("aria-label", row.label);
    this.input.dataset.key = row.key;
    this.output = made(parent, "output");
    this.costs = made(parent, "span");
    this.held = false;
    this.input.addEventListener("pointerdown", () => { this.held = true; });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
      this.input.addEventListener(end, () => { this.held = false; });
    this.input.addEventListener("input", () => {
      const value = this.valueAt(this.input.value / STEPS);
      this.write(value);
      changed(row.key, value);
    });
    this.update(row);
  }

  valueAt(share) {
    const { low, high, whole, logarithmic } = this.row;
    const value = logarithmic ? low * (high / low) ** share : low + share * (high - low);
    return whole ? Math.round(value) : Number(value.toPrecision(3));
  }

  shareOf(value) {
    const { low, high, logarithmic } = this.row;
    if (high <= low) return 0;
    return logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  }

  write(value) {
    this.output.textContent = this.row.whole ? String(value) : String(Number(value.toPrecision(3)));
    this.input.setAttribute("aria-valuetext", this.output.textContent);
  }

  update(row) {
    this.row = row;
    if (!this.held) {
      this.input.value = Math.round(STEPS * this.shareOf(row.value));
      this.write(row.value);
    }
    const told = JSON.stringify(row.costs);
    if (told === this.told) return;
    this.told = told;
    this.costs.replaceChildren();
    for (const { cost, where, meaning } of row.costs) {
      const mark = made(this.costs, "span", `cost ${cost}`, where ? `${cost} ${where}` : cost);
      mark.title = meaning;
    }
  }
}

function render({ model, el }) {
  const page = `${Date.now()}-${Math.random()}`;
  const [width, height] = model.get("_size");
  const root = made(el, "div", "glrt-show");
  root.dataset.lmSuppressShortcuts = "true"; // keys are for the picture, not for the notebook
  const canvas = made(root, "canvas");
  Object.assign(canvas, { width, height, tabIndex: 0, title: HINT });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", model.get("_title"));
  const rows = made(root, "div", "rows");
  const notice = made(root, "div", "notice", "Waiting for the kernel");
  const figures = made(root, "div", "figures");
  made(root, "div", "hint", HINT);
  const sliders = new Map();

  let asked = nothing();
  let askedAt = null; // when a question went out that has no reply yet
  let timer = 0, frame = 0;
  let isOpen = true, isVisible = true, isDone = false;
  let got = 0, drawn = 0;

  function ask() {
    cancelAnimationFrame(frame);
    clearTimeout(timer);
    if (!isOpen || !isVisible) return;
    const now = performance.now();
    if (askedAt !== null && now - askedAt < PATIENCE) return;
    askedAt = now;
    model.send({ kind: "ask", page, asked });
    asked = nothing();
  }

  /** Ask with the next frame of the browser, which has none for a hidden tab. */
  function askSoon() {
    cancelAnimationFrame(frame);
    frame = requestAnimationFrame(ask);
  }

  function change(key, value) {
    if (key.startsWith("light ")) asked.lights[key.slice("light ".length)] = value;
    else asked.settings[key] = value;
    askSoon();
  }

  function show(reply) {
    (reply.rows ?? []).forEach(row => {
      if (sliders.has(row.key)) sliders.get(row.key).update(row);
      else sliders.set(row.key, new Slider(rows, row, change));
    });
    if (reply.figures) figures.replaceChildren(...reply.figures.map(line => {
      const node = document.createElement("div");
      node.textContent = line;
      return node;
    }));
    notice.textContent = reply.notice ?? "";
    notice.classList.toggle("problem", Boolean(reply.is_problem));
  }

  async function draw(buffer, type) {
    const number = ++got;
    const bitmap = await createImageBitmap(new Blob([buffer], { type }));
    if (number > drawn && isOpen) {
      drawn = number;
      canvas.getContext("2d").drawImage(bitmap, 0, 0, canvas.width, canvas.height);
      root.dataset.pictures = String(drawn);
    }
    bitmap.close();
  }

  function hear(reply, buffers) {
    if (!isOpen) return;
    show(reply);
    if (buffers?.length) draw(buffers[0], reply.type).catch(error => { notice.textContent = String(error); });
    if (reply.page !== page) return; // it is the reply to another view of the same picture
    askedAt = null;
    isDone = reply.wait === null;
    const hasInput = JSON.stringify(asked) !== JSON.stringify(nothing());
    if (hasInput || reply.wait === 0) askSoon();
    else if (!isDone) timer = setTimeout(askSoon, 1000 * reply.wait);
  }

  let place = [0, 0]; // of the pointer, in pixels
  canvas.addEventListener("pointerdown", event => {
    place = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener("pointermove", event => {
    if (!(event.buttons & 1)) return;
    const box = canvas.getBoundingClientRect();
    asked.turn[0] += (event.clientX - place[0]) / box.width;
    asked.turn[1] += (event.clientY - place[1]) / box.height;
    place = [event.clientX, event.clientY];
    askSoon();
  });
  canvas.addEventListener("wheel", event => {
    if (document.activeElement !== canvas) return; // else pages could not be scrolled past
    event.preventDefault();
    asked.wheel -= event.deltaMode === 0 ? event.deltaY / LINE : Math.sign(event.deltaY);
    askSoon();
  }, { passive: false });
  canvas.addEventListener("dblclick", () => {
    asked = { ...nothing(), home: true };
    askSoon();
  });
  canvas.addEventListener("keydown", event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key in KEYS) KEYS[event.key].forEach((share, axis) => { asked.turn[axis] += share; });
    else if (event.key in CLICKS) asked.wheel += CLICKS[event.key];
    else if (event.key === "Home") asked = { ...nothing(), home: true };
    else return;
    event.preventDefault();
    askSoon();
  });

  // Off the screen it rests: of many pictures in a notebook, only those in view take time.
  const watch = new IntersectionObserver(entries => {
    isVisible = entries.at(-1).isIntersecting;
    if (isVisible && !isDone) askSoon();
  });
  watch.observe(canvas);

  function close() {
    if (!isOpen) return;
    isOpen = false;
    cancelAnimationFrame(frame);
    clearTimeout(timer);
    watch.disconnect();
    removeEventListener("pagehide", leave);
    model.off("msg:custom", hear);
    model.send({ kind: "close", page });
  }

  const leave = event => { if (!event.persisted) close(); };

  model.on("msg:custom", hear);
  addEventListener("pagehide", leave);
  ask();
  return close;
}

export default { render };
