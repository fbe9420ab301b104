// SPDX-License-Identifier: Apache-2.0
// Draws figures with uPlot. A figure is a description (src/tools/chart/README.md) and columns of numbers; where
// these come from is the caller's affair: `Figure` takes both, the end of this file finds them in a
// page. Text of a log is only ever set as text.
"use strict";

const kelpie = (() => {
  const figures = new Set();
  const windows = new Map(); // group of linked figures: what of x all of them show

  // ---------------------------------------------------------------- numbers

  // Columns as chart/columns.cpp packs them; what isn't finite is null, which breaks a line.
  async function unpack(columns, base64) {
    const letters = atob(base64);
    const packed = new Uint8Array(letters.length);
    for (let i = 0; i < letters.length; ++i) packed[i] = letters.charCodeAt(i);
    const inflated = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(inflated).arrayBuffer());
    let at = 0;
    return columns.map(({ n, width, low, high }) => {
      const values = new Array(n);
      const last = 2 ** (8 * width) - 1;
      let code = 0;
      for (let i = 0; i < n; ++i) {
        let step = 0;
        for (let plane = width - 1; plane >= 0; --plane) step = step * 256 + bytes[at + plane * n + i];
        code = (code + step) % (last + 1);
        values[i] = code === last ? null : low + ((high - low) * code) / (last - 1);
      }
      at += n * width;
      return values;
    });
  }

  function text(value) {
    if (value === null || value === undefined) return "–";
    const size = Math.abs(value);
    const short = size >= 1e7 || (size > 0 && size < 1e-4) ? value.toExponential(3)
      : size >= 1e4 ? value.toFixed(1) : String(Number(value.toPrecision(4)));
    return short.replace("-", "−");
  }

  // Ticks of one axis have the same number of decimals.
  function tickTexts(splits, step) {
    let decimals = 0;
    while (decimals < 9 && Math.abs(step - Number(step.toFixed(decimals))) > 1e-6 * step) ++decimals;
    return splits.map((value) => {
      const plain = Math.abs(value) < 1e7 && step >= 1e-5;
      return (plain ? value.toLocaleString("en", { minimumFractionDigits: decimals,
        maximumFractionDigits: decimals }) : String(Number(value.toPrecision(6)))).replace("-", "−");
    });
  }

  function logTicks(low, high) {
    const ticks = [];
    for (let ten = 10 ** Math.floor(Math.log10(low)); ten <= high; ten *= 10) {
      for (let digit = 1; digit < 10; ++digit) ticks.push(Number((digit * ten).toPrecision(6)));
    }
    return ticks.filter((tick) => tick >= low && tick <= high);
  }

  // Of a logarithmic axis' ticks the powers of ten, then 2 and 5, then the others, as long as there
  // is room between them. `place`: where on the screen a tick is.
  function logTickTexts(splits, place, room) {
    const shown = [];
    const digit = (value) => Math.round(value / 10 ** Math.floor(Math.log10(value) + 1e-9));
    for (const digits of [[1], [2, 5], [3, 4, 6, 7, 8, 9]]) {
      for (const value of splits) {
        const free = shown.every((other) => Math.abs(place(value) - place(other)) >= room);
        if (digits.includes(digit(value)) && free) shown.push(value);
      }
    }
    return splits.map((value) => !shown.includes(value) ? ""
      : value < 1e7 && value >= 1e-4 ? value.toLocaleString("en", { maximumSignificantDigits: 6 })
      : String(Number(value.toPrecision(6))));
  }

  // The first that isn't less.
  function place(ascending, value) {
    let low = 0;
    let high = ascending.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (ascending[middle] < value) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  function nearest(ascending, value) {
    const after = Math.min(place(ascending, value), ascending.length - 1);
    return after > 0 && value - ascending[after - 1] < ascending[after] - value ? after - 1 : after;
  }

  // The least and the greatest in their order; of a band's upper side (1) and lower side (-1) one.
  // A gap (null) among them stays one; a row that is another series' (undefined) is none.
  function extremes(column, begin, end, side) {
    let low = -1;
    let high = -1;
    let gap = -1;
    for (let i = begin; i < end; ++i) {
      const value = column[i];
      if (value === null) gap = i;
      if (typeof value !== "number") continue;
      if (low < 0 || value < column[low]) low = i;
      if (high < 0 || value > column[high]) high = i;
    }
    if (low < 0) return gap < 0 ? [undefined, undefined] : [null, null];
    if (side > 0) low = high;
    if (side < 0) high = low;
    const pair = [column[Math.min(low, high)], column[Math.max(low, high)]];
    if (gap >= 0) pair[2 * (gap - begin) < end - 1 - begin ? 0 : 1] = null;
    return pair;
  }

  // ---------------------------------------------------------------- looks

  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const colour = (of) => style(`--s${of % 7}`);
  const look = (of) => (of + Math.floor(of / 7)) % 7; // dash and shape: from the eighth on others
  const dashes = [[], [7, 3], [2, 2.5], [9, 3, 2, 3], [5, 2, 1, 2, 1, 2], [12, 5], [4, 4]];
  const shapes = [ // around (0, 0), about 8 pixels
    (c) => c.arc(0, 0, 3, 0, 7),
    (c) => { c.moveTo(-3, -3); c.lineTo(3, 3); c.moveTo(-3, 3); c.lineTo(3, -3); },
    (c) => c.rect(-3, -3, 6, 6),
    (c) => { c.moveTo(0, -4); c.lineTo(4, 3); c.lineTo(-4, 3); c.closePath(); },
    (c) => { c.moveTo(0, -4); c.lineTo(4, 0); c.lineTo(0, 4); c.lineTo(-4, 0); c.closePath(); },
    (c) => { c.moveTo(-4, 0); c.lineTo(4, 0); c.moveTo(0, -4); c.lineTo(0, 4); },
    (c) => { c.moveTo(0, 4); c.lineTo(4, -3); c.lineTo(-4, -3); c.closePath(); },
  ];

  function drawShape(context, of, x, y, scale) {
    context.setTransform(scale, 0, 0, scale, x, y);
    context.beginPath();
    shapes[look(of)](context);
    context.stroke();
    context.setTransform(1, 0, 0, 1, 0, 0);
  }

  function element(tag, attributes, parent, content) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    if (content !== undefined) made.textContent = content;
    parent?.append(made);
    return made;
  }

  // ---------------------------------------------------------------- one figure

  class Figure {
    constructor(parent, description, columns) {
      this.parent = parent;
      this.description = description;
      this.group = description.link ?? this;
      this.frame = element("div", { class: "frame", tabindex: 0, role: "application",
        "aria-label": description.label + " Arrow keys move the cursor, with Shift the window; " +
          "plus and minus zoom, 0 shows everything." }, parent);
      this.legend = element("div", { class: "legend" }, parent);
      this.setColumns(columns);
      this.makeLegend();
      this.listen();
      figures.add(this);
    }

    // Other numbers under the same description, as when more of them have arrived.
    setColumns(columns) {
      this.table = this.joined(columns);
      this.thinned = new Map(); // step: the table's least and greatest of each `step` rows
      this.isFull = this.table.map((ys) => // a joined table has holes, few or many
        ys.reduce((holes, y) => holes + (y === undefined ? 1 : 0), 0) < 0.1 * ys.length);
      const xs = this.table[0];
      const range = this.description.x.range;
      const before = windows.get(this.group);
      const sawAll = before && this.whole?.every((end, i) => end === before[i]);
      this.whole = range ?? this.widened(xs[0], xs[xs.length - 1]);
      if (this.description.start && !before) windows.set(this.group, this.description.start);
      this.plot ??= new uPlot(this.options(), this.table.map((column) => column.slice(0, 2)), this.frame);
      if (sawAll) windows.set(this.group, this.whole);
      this.show(windows.get(this.group) ?? this.whole);
    }

    // uPlot wants one column of x for all series: those with their own are joined.
    joined(columns) {
      const groups = new Map();
      this.rows = [];
      for (const series of this.description.series) {
        const group = groups.get(series.x) ?? groups.set(series.x, []).get(series.x);
        const ys = columns[series.y];
        if (series.kind === "band") {
          const half = columns[series.half];
          const side = (sign) => ys.map((y, i) => y === null || half[i] === null ? null : y + sign * half[i]);
          group.push([series, side(1)], [series, side(-1)]);
        } else {
          group.push([series, ys]);
        }
      }
      const tables = [];
      for (const [x, members] of groups) {
        tables.push([columns[x], ...members.map(([, ys]) => ys)]);
        for (const [series] of members) this.rows.push(series); // row i + 1 of the joined table
      }
      return tables.length === 1 ? tables[0] : uPlot.join(tables);
    }

    // What of the table a window needs: all of its samples, or where they are denser than pixels the
    // least and the greatest of each column of pixels, which look the same. Steps are powers of two,
    // so that there are few of them, and panning costs what the pixels do, however many samples.
    seen(low, high) {
      const xs = this.table[0];
      const first = Math.max(0, place(xs, low) - 1);
      const end = Math.min(xs.length, place(xs, high) + 2);
      const step = 2 ** Math.floor(Math.log2((2 * (end - first)) / (this.plot.width - 70)));
      this.isThinned = step >= 4;
      if (!this.isThinned) return this.table.map((column) => column.slice(first, end));
      if (!this.thinned.has(step)) this.thinned.set(step, this.extremes(step));
      return this.thinned.get(step).map((column) =>
        column.slice(2 * Math.floor(first / step), 2 * Math.ceil(end / step)));
    }

    extremes(step) {
      const xs = this.table[0];
      const starts = [];
      for (let at = 0; at < xs.length; at += step) starts.push(at);
      return this.table.map((column, row) => {
        if (row === 0) return starts.flatMap((at) => [xs[at], xs[Math.min(at + (step >> 1), xs.length - 1)]]);
        const side = this.rows[row - 1].kind !== "band" ? 0 : this.rows[row] === this.rows[row - 1] ? 1 : -1;
        return starts.flatMap((at) => extremes(column, at, Math.min(at + step, xs.length), side));
      });
    }

    options() {
      const { x, y } = this.description;
      const ink = () => style("--ink");
      const axis = (of, isX) => ({
        label: of.label, stroke: ink, font: "12px system-ui, sans-serif",
        labelFont: "12px system-ui, sans-serif", labelSize: 18, gap: 3,
        grid: { stroke: () => style("--grid"), width: 1 },
        ticks: { stroke: () => style("--grid"), width: 1, size: 5 },
        size: isX ? 28 : (u, texts) => 16 + 6.6 * Math.max(5, ...(texts ?? []).map((t) => t.length)),
        // A phone's figure, or a low one, has two ticks at least: one tells no scale.
        space: isX ? (u, index, low, high, room) => of.names ? 10 : room > 400 ? 75 : 55
          : this.description.height < 200 ? 20 : 30,
        ...(of.names ? { splits: () => of.names.map((_, i) => i), values: () => of.names }
          : of.log ? { splits: (u, axis, low, high) => logTicks(low, high), filter: (u, splits) => splits, values: (u, splits) =>
              logTickTexts(splits, (v) => u.valToPos(v, isX ? "x" : "y"), isX ? 50 : 20) }
          : { values: (u, splits, a, b, step) => tickTexts(splits, step) }),
      });
      const fromZero = this.rows.some((one) => one.kind === "bars") && !y.log; // a bar's length counts
      const scale = (of, range) => ({ time: false, distr: of.log ? 3 : 1, ...(range ? { range } : {}) });
      const bands = [];
      const lines = uPlot.paths.linear();
      const series = this.rows.map((one, i) => {
        const isBand = one.kind === "band";
        if (isBand && this.rows[i + 1] === one) bands.push({ series: [i + 1, i + 2],
          fill: () => `color-mix(in srgb, ${colour(one.style)} 24%, transparent)` });
        return { label: String(i), points: { show: false },
          stroke: isBand ? "transparent" : () => colour(one.style), width: isBand ? 0 : 1.5,
          ...(one.kind === "points" ? { paths: () => null } : {}),
          ...(one.kind === "line" || isBand ? { paths: (...of) => this.isDense(i + 1) ? null : lines(...of) } : {}),
          ...(one.kind === "bars" ? { paths: uPlot.paths.bars({ size: [0.96, 100] }),
            fill: () => colour(one.style) } : {}) };
      });
      return {
        ...this.size(), padding: [this.description.marks.length > 0 ? 21 : 8, 18, 0, 0],
        legend: { show: false }, axes: [axis(x, true), axis(y, false)],
        scales: { x: scale(x, (u, low, high) => [low, high]), y: scale(y, y.range ??
          (fromZero ? (u, low, high) => [Math.min(0, low), uPlot.rangeNum(0, high, 0.1, true)[1]] : undefined)) },
        series: [{}, ...series], bands,
        cursor: { sync: this.description.link ? { key: this.description.link, setSeries: false,
            scales: ["x", null] } : undefined,
          drag: { x: true, y: false, dist: 5 }, points: { size: 6 },
          bind: { mousedown: (u, target, act) => (event) => event.shiftKey ? null : act(event),
            dblclick: () => () => this.showAll(this.whole) } },
        hooks: { drawClear: [(u) => this.chooseDashes(u)], draw: [(u) => this.drawDense(u), (u) => this.drawMore(u)],
          setCursor: [() => this.tell()], setSelect: [(u) => this.selected(u)] },
      };
    }

    // Printed, what fits on a page of A4 or letter, one figure or two beside each other.
    size() {
      const isPrinted = document.documentElement.classList.contains("printing");
      const room = !isPrinted ? this.parent.clientWidth : this.parent.closest(".panels") ? 325 : 680;
      const width = Math.max(260, this.description.square ? Math.min(room, 420) : room);
      return { width, height: this.description.square ? Math.min(width, 380)
        : Math.min(this.description.height ?? 270, Math.max(200, 0.7 * width)) };
    }

    // Dashes can't be told in a dense line, and cost more than all else.
    chooseDashes(u) {
      const [first, last] = u.series[0].idxs;
      const dense = last - first > u.width / 2;
      this.rows.forEach((one, i) => {
        if (one.kind !== "line") return;
        u.series[i + 1].dash = dense ? undefined : dashes[look(one.style)];
        u.series[i + 1].width = dense ? 1 : 1.5;
      });
    }

    // Whether a line or band is drawn column by column: upright bars from the least to the greatest
    // look like a stroke along the samples, at a tenth of its cost.
    isDense(row) { return this.isThinned && this.isFull[row]; }

    drawDense(u) {
      if (!this.isThinned) return;
      const context = u.ctx;
      const { left, top, width, height } = u.bbox;
      const [xs, thin] = [u.data[0], Math.max(1, Math.round(devicePixelRatio))];
      const edges = [];
      for (let i = 0; i < xs.length; i += 2) edges.push(Math.round(u.valToPos(xs[i], "x", true)));
      edges.push(Math.round(u.valToPos(xs[xs.length - 1], "x", true)));
      // A column ahead of a gap ends with its samples: the next one may begin far behind them.
      const lastOf = (k) =>
        Math.min(edges[k + 1], 2 * Math.round(u.valToPos(xs[2 * k + 1], "x", true)) - edges[k]);
      const bar = (from, to, low, high) => {
        const y = Math.round(u.valToPos(high, "y", true));
        context.fillRect(from, y, Math.max(thin, to - from),
          Math.max(thin, Math.round(u.valToPos(low, "y", true)) - y));
      };
      context.save();
      context.beginPath();
      context.rect(left, top, width, height);
      context.clip();
      this.rows.forEach((one, i) => {
        const isUpper = one.kind === "band" && this.rows[i + 1] === one;
        if (!u.series[i + 1].show || !this.isDense(i + 1) || (one.kind !== "line" && !isUpper)) return;
        const [ys, lower] = [u.data[i + 1], u.data[i + 2]];
        context.fillStyle = colour(one.style);
        context.globalAlpha = isUpper ? 0.24 : 1;
        let before = null;
        for (let k = 0; k + 1 < edges.length; ++k) {
          const [first, last] = [ys[2 * k], ys[2 * k + 1]]; // one of them is null beside a gap
          if (first === undefined) continue;
          const [a, b] = isUpper ? [first, lower[2 * k]] : [first ?? last, last ?? first];
          const join = isUpper || first === null ? null : before;
          const [from, to] = first === null ? [edges[k + 1] - thin, edges[k + 1]]
            : [edges[k], last === null ? edges[k] : ys[2 * k + 2] === null ? lastOf(k) : edges[k + 1]];
          if (a !== null && b !== null) bar(from, to, Math.min(a, b, join ?? a), Math.max(a, b, join ?? a));
          before = last;
        }
      });
      context.restore();
    }

    // Marks, guides and markers, over what uPlot has drawn.
    drawMore(u) {
      const context = u.ctx;
      const ratio = devicePixelRatio;
      const { left, top, width, height } = u.bbox;
      const place = (x, y) => [u.valToPos(x, "x", true), u.valToPos(y, "y", true)];
      context.save();
      context.strokeStyle = context.fillStyle = style("--ink");
      context.lineWidth = ratio;
      context.setLineDash([4 * ratio, 3 * ratio]);
      context.font = `${11 * ratio}px system-ui, sans-serif`;
      let free = left;
      for (const mark of this.description.marks) {
        const at = u.valToPos(mark.x, "x", true);
        if (at < left || at > left + width) continue;
        context.stroke(new Path2D(`M${at} ${top}V${top + height}`));
        const half = context.measureText(mark.name).width / 2;
        // Labels never overlap: one beside another moves aside as long as it reaches its mark.
        const middle = Math.min(Math.max(at, free + half), left + width - half);
        if (middle - half < free || middle - half > at + 4 * ratio) continue;
        context.textAlign = "center";
        context.fillText(mark.name, middle, top - 8 * ratio);
        free = middle + half + 8 * ratio;
      }
      context.beginPath();
      context.rect(left - 5 * ratio, top - 5 * ratio, width + 10 * ratio, height + 10 * ratio);
      context.clip(); // markers on the edge are whole
      for (const [x0, y0, x1, y1] of this.description.guides) {
        context.stroke(new Path2D(`M${place(x0, y0).join(" ")}L${place(x1, y1).join(" ")}`));
      }
      context.setLineDash([]);
      context.lineWidth = 1.4;
      this.rows.forEach((one, i) => this.drawMarkers(u, one, i + 1, place));
      context.restore();
    }

    // Points each have their shape; of a line a few do, so that lines differ not by colour alone.
    drawMarkers(u, one, row, place) {
      if (!u.series[row].show || (one.kind !== "points" && one.kind !== "line")) return;
      const [first, last] = u.series[0].idxs;
      const ys = u.data[row];
      const all = one.kind === "points";
      const stride = all ? 1 : Math.max(1, Math.floor((last - first) / 8));
      u.ctx.strokeStyle = colour(one.style);
      for (let i = first + (all ? 0 : Math.floor((stride * (1 + (one.style % 7))) / 8)); i <= last; i += stride) {
        let at = i; // a joined table has holes
        while (!all && at <= last && at < i + stride && ys[at] === undefined) ++at;
        if (typeof ys[at] !== "number") continue;
        const [x, y] = place(u.data[0][at], ys[at]);
        if (one.small) u.ctx.strokeRect(x - 0.5, y - 0.5, 1, 1);
        else drawShape(u.ctx, one.style, x, y, devicePixelRatio);
      }
    }

    // A button for each series, with a sample of its look and the value under the cursor.
    makeLegend() {
      this.entries = [];
      this.rows.forEach((one, i) => {
        if (!one.name || this.rows[i - 1] === one) return;
        const button = element("button", { type: "button", "aria-pressed": "true" }, this.legend);
        const sample = element("canvas", { width: 56, height: 28, "aria-hidden": "true" }, button);
        element("span", { class: "name", dir: "auto" }, button, one.name);
        const value = element("output", {}, button);
        const rows = this.rows.flatMap((other, k) => (other === one ? [k + 1] : []));
        button.onclick = () => {
          const shown = button.getAttribute("aria-pressed") !== "true";
          button.setAttribute("aria-pressed", shown);
          for (const row of rows) this.plot.setSeries(row, { show: shown });
        };
        this.entries.push({ one, rows, value, sample });
      });
      this.when = element("output", { class: "when" }, this.legend);
      const tools = element("span", { class: "tools" }, this.legend);
      const tool = (sign, meaning, act) => {
        element("button", { type: "button", "aria-label": meaning, title: meaning }, tools, sign).onclick = act;
      };
      tool("◂", "earlier", () => this.pan(-0.25));
      tool("▸", "later", () => this.pan(0.25));
      tool("+", "zoom in", () => this.zoom(0.5));
      tool("−", "zoom out", () => this.zoom(2));
      tool("all", "show everything", () => this.showAll(this.whole));
      this.drawSamples();
    }

    drawSamples() {
      for (const { one, sample } of this.entries) {
        const context = sample.getContext("2d");
        context.clearRect(0, 0, 56, 28);
        context.strokeStyle = context.fillStyle = colour(one.style);
        context.lineWidth = 3;
        if (one.kind === "line") {
          context.setLineDash(dashes[look(one.style)].map((length) => 2 * length));
          context.stroke(new Path2D("M2 14H54"));
          context.setLineDash([]);
        } else if (one.kind !== "points") {
          context.globalAlpha = one.kind === "band" ? 0.24 : 1;
          context.fillRect(6, 4, 44, 20);
        }
        context.lineWidth = 1.4;
        if (one.small) context.fillRect(24, 10, 8, 8);
        else if (one.kind === "line" || one.kind === "points") drawShape(context, one.style, 28, 14, 2);
      }
    }

    // ---------------------------------------------------------------- cursor and window

    tell() {
      if (!this.entries) return; // not yet made
      const { x } = this.description;
      const { left } = this.plot.cursor;
      const at = left >= 0 ? nearest(this.table[0], this.plot.posToVal(left, "x")) : -1;
      const value = this.table[0][at];
      this.when.textContent = value === undefined ? "" : `${x.names?.[Math.round(value)] ?? text(value)} (${x.label})`;
      for (const { one, rows, value: output } of this.entries) {
        const values = rows.map((row) => this.table[row][at]);
        output.textContent = value === undefined ? ""
          : one.kind === "band" ? `${text(values[1])} … ${text(values[0])}` : text(values[0]);
      }
    }

    selected(u) {
      const { left, width } = u.select;
      if (width > 0) this.showAll([u.posToVal(left, "x"), u.posToVal(left + width, "x")]);
      u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    }

    show([low, high]) {
      this.window = [low, high];
      this.plot.batch(() => {
        this.plot.setData(this.seen(low, high), false);
        this.plot.setScale("x", { min: low, max: high });
      });
    }

    // The same window in all figures of the group, within what this one has; at most once a frame.
    showAll([low, high]) {
      const [first, last] = this.whole.map((v) => this.toScale(v));
      const length = Math.min(last - first, this.toScale(high) - this.toScale(low));
      const from = Math.min(Math.max(this.toScale(low), first), last - length);
      if (!(length > 1e-9 * Math.abs(last - first))) return;
      const wanted = length === last - first ? this.whole : [this.fromScale(from), this.fromScale(from + length)];
      const due = this.due;
      windows.set(this.group, wanted);
      this.due = true;
      if (!due) requestAnimationFrame(() => {
        this.due = false;
        for (const one of figures) if (one.group === this.group && one.visible) one.follow();
      });
    }

    follow() {
      const [low, high] = windows.get(this.group) ?? this.whole;
      if (low !== this.window[0] || high !== this.window[1]) this.show([low, high]);
    }

    // With room for the outermost markers and bars.
    widened(low, high) {
      const [from, to] = [this.toScale(low), this.toScale(high)];
      const lines = this.description.series.some((one) => one.kind === "line");
      const room = from === to ? Math.abs(from) || 1 : lines ? 0 : 0.04 * (to - from);
      if (room === 0) return [low, high]; // rounded, the first sample would be outside
      return [this.fromScale(from - room), this.fromScale(to + room)];
    }

    toScale(value) { return this.description.x.log ? Math.log10(value) : value; }
    fromScale(value) { return this.description.x.log ? 10 ** value : value; }
    current() { return (windows.get(this.group) ?? this.window).map((v) => this.toScale(v)); }

    // `at`: what stays where it is, as a share of the window.
    zoom(factor, at = 0.5) {
      const [low, high] = this.current();
      const still = low + at * (high - low);
      this.showAll([still + (low - still) * factor, still + (high - still) * factor].map((v) => this.fromScale(v)));
    }

    pan(share) {
      const [low, high] = this.current();
      const by = share * (high - low);
      this.showAll([low + by, high + by].map((v) => this.fromScale(v)));
    }

    moveCursor(by) {
      const width = this.plot.over.clientWidth;
      const old = this.plot.cursor.left >= 0 ? this.plot.cursor.left : width / 2;
      const left = Math.min(Math.max(old + by, 0), width);
      this.plot.setCursor({ left, top: this.plot.over.clientHeight / 2 }, true, true);
      this.when.setAttribute("aria-live", "polite");
    }

    // ---------------------------------------------------------------- keyboard, wheel, fingers

    listen() {
      this.frame.onkeydown = (event) => {
        const sideways = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        if (sideways && event.shiftKey) this.pan(0.2 * sideways);
        else if (sideways) this.moveCursor(8 * sideways);
        else if (event.key === "+" || event.key === "=") this.zoom(0.5);
        else if (event.key === "-") this.zoom(2);
        else if (event.key === "0") this.showAll(this.whole);
        else return;
        event.preventDefault();
      };
      const over = this.plot.over;
      over.addEventListener("wheel", (event) => { // without a key the wheel scrolls the page
        if (!event.ctrlKey && !event.shiftKey) return;
        event.preventDefault();
        if (event.shiftKey) this.pan((event.deltaX + event.deltaY) / 1000);
        else this.zoom(2 ** (event.deltaY / 200), event.offsetX / over.clientWidth);
      }, { passive: false });
      // Fingers, or the mouse with Shift: one pans, two zoom around their middle.
      const fingers = new Map();
      const reach = () => {
        const xs = [...fingers.values()];
        return { middle: xs.reduce((a, b) => a + b, 0) / xs.length, wide: Math.max(...xs) - Math.min(...xs) };
      };
      over.onpointerdown = (event) => {
        if (event.pointerType === "mouse" && !event.shiftKey) return;
        fingers.set(event.pointerId, event.clientX);
        over.setPointerCapture(event.pointerId);
      };
      over.onpointermove = (event) => {
        if (!fingers.has(event.pointerId)) return;
        const before = reach();
        fingers.set(event.pointerId, event.clientX);
        const after = reach();
        this.pan((before.middle - after.middle) / over.clientWidth);
        if (before.wide > 10 && after.wide > 10) this.zoom(before.wide / after.wide,
          (after.middle - over.getBoundingClientRect().left) / over.clientWidth);
      };
      over.onpointerup = over.onpointercancel = (event) => fingers.delete(event.pointerId);
    }

    redraw() {
      this.drawSamples();
      this.follow();
      this.plot.setSize(this.size());
      this.plot.redraw(false);
    }
  }

  // ---------------------------------------------------------------- a page of figures

  // A figure of errors from the columns of the figure above: one line less another, and the interval.
  function errorsOf({ series, errors, ...description }, columns) {
    const find = (name) => series.find((one) => one.kind === "line" && one.name === name);
    const [of, from] = [find(errors.of), find(errors.from)];
    const band = series.find((one) => one.kind === "band");
    if (!of || !from) return null;
    const zeros = columns[of.y].map(() => 0);
    const error = columns[of.y].map((y, i) =>
      y === null || columns[from.y][i] === null ? null : y - columns[from.y][i]);
    const [zero, at] = [columns.length, columns.length + 1];
    const label = `${errors.of} less ${errors.from}`;
    return [{ ...description, label: `${description.label} ${label}.`, marks: [], height: 150,
      y: { label: errors.label }, guides: [],
      series: [...(band ? [{ ...band, y: zero }] : []),
        { kind: "line", name: label, style: 0, x: of.x, y: at }] }, [...columns, zeros, error]];
  }

  async function start(parent) {
    const description = JSON.parse(parent.querySelector("script").textContent);
    const columns = await unpack(description.columns, description.data);
    parent.querySelector(".still").hidden = true;
    const plot = parent.querySelector(".plot");
    const below = description.errors ? errorsOf(description, columns) : null;
    for (const [what, numbers] of [[description, columns], ...(below ? [below] : [])]) {
      const figure = new Figure(element("div", {}, plot), what, numbers);
      new IntersectionObserver((entries) => {
        figure.visible = entries.some((entry) => entry.isIntersecting);
        if (figure.visible) figure.follow();
      }, { rootMargin: "100px" }).observe(figure.frame);
    }
    performance.mark("kelpie-figure");
  }

  function redrawAll(within = document) {
    for (const figure of figures) if (within.contains(figure.frame)) figure.redraw();
  }

  // A link into a folded part opens it; figures there get their width then.
  function openTarget() {
    const target = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
    if (!target) return;
    for (let one = target; one; one = one.parentElement) if (one.tagName === "DETAILS") one.open = true;
    target.scrollIntoView();
  }

  // One figure after the other from the top, so that the first is there at once.
  async function startPage() {
    const printing = (now) => {
      document.documentElement.classList.toggle("printing", now);
      redrawAll();
    };
    addEventListener("beforeprint", () => printing(true));
    addEventListener("afterprint", () => printing(false));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redrawAll());
    addEventListener("hashchange", openTarget);
    document.addEventListener("toggle", (event) => redrawAll(event.target), true);
    for (const parent of document.querySelectorAll("figure.chart")) {
      await start(parent);
      await new Promise((done) => setTimeout(done));
    }
    let width = document.body.clientWidth;
    new ResizeObserver(() => {
      if (document.body.clientWidth !== width) redrawAll();
      width = document.body.clientWidth;
    }).observe(document.body);
    openTarget();
    performance.mark("kelpie-all");
  }

  return { Figure, unpack, startPage, figures };
})();

if ("DecompressionStream" in window) kelpie.startPage(); // an older browser shows the sentences
