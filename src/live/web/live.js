// SPDX-License-Identifier: Apache-2.0
// The page of `kelpie live`: listens to /events (web/events.hpp) and draws with figure.js. Names of
// a vehicle are only ever set as text.
"use strict";

const live = (() => {
  const at = (id) => document.getElementById(id);
  const kDrawMs = 250; // quicker than the eye needs
  const kMostSaid = 100;
  const kMostAlarms = 3;
  let plan = null;
  let columns = []; // time, then measured, predicted, middle and half of the interval of each axis
  let figures = [];
  let drawn = 0; // when
  let isDue = false;
  let isPaused = false;
  let last = null; // health
  const title = document.title;

  function made(tag, content, attributes = {}) {
    const one = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
    if (content !== undefined) one.textContent = content;
    return one;
  }

  function number(value, digits = 3) {
    if (value === null || value === undefined) return "–";
    const size = Math.abs(value);
    const short = size >= 1e5 || (size > 0 && size < 1e-3) ? value.toExponential(digits - 1)
      : String(Number(value.toPrecision(digits)));
    return short.replaceAll("-", "−");
  }
  // With the zeros at the end: numbers below each other have as many digits.
  function even(value, digits = 3) {
    if (value === null || value === undefined) return "–";
    const size = Math.abs(value);
    return size === 0 ? "0" : size < 1e-3 || size >= 10 ** digits ? number(value, digits)
      : value.toPrecision(digits).replace("-", "−");
  }
  const count = (value) => value.toLocaleString("en");
  const fixed = (value, digits) => value === null ? "–" : value.toFixed(digits).replace("-", "−");

  // ---------------------------------------------------------------- curves

  function begin(given) {
    plan = given;
    columns = Array.from({ length: 1 + 4 * plan.axes.length }, () => []);
    at("source").textContent = plan.source;
    at("said").replaceChildren();
    if (figures.length > 0) return;
    for (const [i, axis] of plan.axes.entries()) {
      const parent = made("figure", undefined, { class: "live" });
      at("curves").append(made("h3", axis.name, { dir: "auto" }), parent);
      figures.push({ parent, axis, first: 1 + 4 * i });
    }
  }

  function description({ axis, first }) {
    return {
      label: `${axis.name}: measured, predicted beforehand, and the interval.`,
      x: { label: "time in s" }, y: { label: axis.unit ? `${axis.name} in ${axis.unit}` : axis.name },
      link: "time", marks: [], guides: [], height: 220,
      series: [
        { kind: "band", name: "interval", style: 1, x: 0, y: first + 2, half: first + 3 },
        { kind: "line", name: "measured", style: 0, x: 0, y: first },
        { kind: "line", name: "predicted", style: 1, x: 0, y: first + 1 }],
    };
  }

  function push(t, values) {
    columns[0].push(t);
    for (let i = 0; i < plan.axes.length; ++i) {
      const [measured, predicted, lower, upper] = values ? values.slice(1 + 4 * i, 5 + 4 * i) : [];
      const has = typeof lower === "number" && typeof upper === "number";
      [measured ?? null, predicted ?? null, has ? (lower + upper) / 2 : null,
        has ? (upper - lower) / 2 : null].forEach((value, k) => columns[1 + 4 * i + k].push(value));
    }
  }

  function take(rows) {
    for (const row of rows) {
      const last = columns[0].at(-1);
      if (row[0] <= last) for (const column of columns) column.length = 0; // a clock was set
      else if (row[0] - last > plan.gap_s) push((row[0] + last) / 2, null); // breaks the lines
      push(row[0], row);
    }
    const oldest = columns[0].at(-1) - plan.window_s;
    const drop = columns[0].findIndex((t) => t >= oldest);
    if (drop > 0) for (const column of columns) column.splice(0, drop);
    draw();
  }

  function draw() {
    if (isDue || columns[0].length < 2 || !("uPlot" in window)) return;
    isDue = true;
    setTimeout(() => requestAnimationFrame(() => {
      isDue = false;
      drawn = performance.now();
      if (columns[0].length < 2) return;
      for (const one of figures) {
        if (one.figure) {
          one.figure.setColumns(columns);
        } else {
          one.figure = new kelpie.Figure(one.parent, description(one), columns);
          one.figure.visible = true;
        }
      }
    }), Math.max(0, drawn + kDrawMs - performance.now()));
  }

  // ---------------------------------------------------------------- tables

  // Rows of texts under a head. Only what differs is touched, so that a selection stays.
  function table(place, head, rows, css = "") {
    if (!place.firstChild) {
      const scroll = made("div", undefined, { class: "scroll", tabindex: 0 });
      const whole = made("table", undefined, { class: css });
      const titles = made("tr");
      titles.append(...head.map((title) => made("th", title, { scope: "col" })));
      const top = made("thead");
      if (head.length > 0) top.append(titles);
      whole.append(top, made("tbody"));
      scroll.append(whole);
      place.append(scroll);
    }
    const body = place.querySelector("tbody");
    while (body.rows.length > rows.length) body.deleteRow(-1);
    rows.forEach((cells, i) => {
      const row = body.rows[i] ?? body.insertRow();
      cells.forEach((cell, k) => {
        const one = row.cells[k] ?? row.appendChild(
          k === 0 ? made("th", "", { scope: "row", dir: "auto" }) : made("td", "", { dir: "auto" }));
        if (one.textContent !== cell) one.textContent = cell;
      });
    });
  }

  // What a field of the health table (live/health_table.cpp) holds, for people.
  function shown(field, one) {
    const value = Array.isArray(one[field.key]) ? one[field.key][field.place] : one[field.key];
    if (value === null || value === "") return "–";
    if (field.key === "r2") return Math.abs(value) < 10 ? fixed(value, 3) : number(value);
    return { count, text: (text) => text, flag: (flag) => flag ? "yes" : "no",
      share: (share) => `${fixed(100 * share, share < 0.1 ? 1 : 0)} %` }[field.kind]?.(value) ?? (plan.fields.velocities.includes(field) ? even : number)(value);
  }

  // A row for each of `list`: name, cells before, a cell per field, cells behind.
  function listed(place, fields, list, before = {}, behind = {}, css = "") {
    table(place, ["name", ...Object.keys(before), ...fields.map(({ label }) => label), ...Object.keys(behind)],
      list.map((one) => [one.name, ...Object.values(before).map((cell) => cell(one)),
        ...fields.map((field) => shown(field, one)), ...Object.values(behind).map((cell) => cell(one))]), css);
  }

  function condition(signal, { alerts, topics }) {
    const topic = topics.find((one) => signal.from.startsWith(one.name + ":"));
    return alerts.filter(({ subject }) => subject === signal.name || (topic && subject === topic.name))
      .map(({ text }) => `⚠ ${text}`).join("; ") || "well";
  }

  function coefficient({ value, error, unit, term }, axis) {
    return [axis, term, even(value, 4), error === null ? "" : `± ${even(error, 2)}`, unit];
  }

  // What an operator has to know first: the vehicle, then what else is wrong.
  function alarm({ alerts }) {
    const place = at("alarm");
    const subjects = new Map(); // by text: of some axes the text is the same
    for (const { text, subject, level, key } of
      [...alerts].sort((a, b) => (b.key === "vehicle") - (a.key === "vehicle"))) {
      if (level === "ok" || ["ready", "learning_paused"].includes(key)) continue;
      if (!subjects.has(text)) subjects.set(text, []);
      if (subject && !text.includes(subject)) subjects.get(text).push(subject);
    }
    const lines = [...subjects].slice(0, kMostAlarms)
      .map(([text, names]) => names.length > 0 ? `${text}: ${names.join(", ")}` : text);
    const told = lines.join("\n");
    if (place.dataset.told === told) return;
    place.dataset.told = told;
    place.hidden = lines.length === 0;
    place.className = alerts.some(({ level, key }) => level === "error" || key === "vehicle") ? "bad" : "warn";
    place.replaceChildren(...lines.map((line) => made("p", `⚠ ${line}`, { dir: "auto" })));
    document.title = lines.length === 0 ? title : `⚠ ${title}`;
  }

  function showSignals(health) {
    listed(at("signals"), plan.fields.signals.filter(({ kind }) => kind !== "flag"), health.signals,
      { from: ({ from }) => from, condition: (signal) => condition(signal, health) },
      { "found since the start": ({ found }) => found || "–" }, "signals");
  }

  function show(health) {
    last = health;
    alarm(health);
    isPaused = health.learning_paused;
    at("freeze").textContent = isPaused ? "Resume learning" : "Freeze learning";
    say(isPaused ? "❚❚ Learning is frozen: the model stays as it is"
      : health.alerts.some(({ key }) => key === "idle_s") ? "⚠ No messages come"
      : health.axes.every((axis) => axis.ready) ? "▶ Learning" : "▶ Learning; too few samples for a model so far",
    `${count(health.learned)} samples learned, ${number(health.t, 6)}\u00a0s`);
    const { run, axes, thrusters, velocities, parameters } = plan.fields;
    const isGood = ({ key, place }) => (key === "r2" && place < 2) || key === "coverage";
    listed(at("good"), axes.filter(isGood), health.axes);
    listed(at("learners"), axes.filter((field) => !isGood(field)), health.axes);
    showSignals(health);
    const all = health.axes.flatMap((axis) => axis.coefficients.map((one) => coefficient(one, axis.name)));
    table(at("coefficients"), ["axis", "term", "coefficient", "standard error", "unit"], all, "coefficients");
    table(at("facts"), [], run.map((field) => [field.label, shown(field, health), field.help]), "facts");
    if (health.velocities.length > 0) listed(at("velocities"), velocities, health.velocities);
    if (health.thrusters.length > 0) listed(at("thrusters"), thrusters, health.thrusters);
    at("known").hidden = health.countdown === "";
    at("countdown").textContent = health.countdown;
    listed(at("parameters"), parameters, health.parameters);
  }

  // What is said aloud changes seldom; what counts up isn't said.
  function say(state, rest = "") {
    const place = at("state");
    if (place.dataset.state !== state) {
      place.dataset.state = state;
      place.replaceChildren(made("b", state), made("span", "", { "aria-live": "off" }));
    }
    place.lastChild.textContent = rest ? ` · ${rest}` : "";
  }

  function hear(lines) {
    for (const [ms, text] of lines) {
      const item = made("li", undefined, { dir: "auto" });
      item.append(made("time", new Date(ms).toLocaleTimeString("en-GB")), " ", text);
      at("said").prepend(item);
    }
    while (at("said").children.length > kMostSaid) at("said").lastChild.remove();
  }

  // ---------------------------------------------------------------- the program

  function listen() {
    const events = new EventSource("/events");
    const on = (name, take) => events.addEventListener(name, (event) => take(JSON.parse(event.data)));
    on("plan", begin);
    on("samples", take);
    on("said", hear);
    on("health", show);
    on("end", () => {
      events.close();
      if (last) { // all signals are silent now
        alarm({ alerts: last.alerts.filter(({ key }) => key === "vehicle") });
        showSignals({ ...last, alerts: last.alerts.filter(({ key }) => key !== "is_silent") });
      }
      say("■ The run has ended", "figures and numbers are those of its end");
      for (const id of ["save", "freeze", "reset"]) at(id).disabled = true;
    });
    events.onerror = () => {
      say("✕ No connection to kelpie; trying again");
      if (events.readyState === EventSource.CLOSED) setTimeout(listen, 3000);
    };
  }

  async function ask(what) {
    try {
      const answer = await fetch("/" + what, { method: "POST" });
      if (!answer.ok) hear([[Date.now(), `${what}: ${(await answer.text()).trim()}`]]);
    } catch {
      hear([[Date.now(), `${what}: no connection to kelpie`]]);
    }
  }

  at("save").onclick = () => ask("save");
  at("freeze").onclick = () => ask(isPaused ? "resume" : "freeze");
  at("reset").onclick = () => at("ask").showModal();
  at("no").onclick = () => at("ask").close();
  at("yes").onclick = () => { at("ask").close(); ask("reset"); };
  listen();

  return { figures: () => figures, columns: () => columns, health: () => last, show };
})();
