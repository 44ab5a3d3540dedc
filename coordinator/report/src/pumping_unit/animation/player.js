// Moves the parts of the drawing of the machine. Reads the film once, then only sets attributes.
horsehead.parts.push(function (part) {
  "use strict";
  var data = part.querySelector("#machine-film");
  if (!data) { return; }
  var film = JSON.parse(data.textContent);
  var get = function (name) { return document.getElementById("machine-" + name); };
  var frames = film.turn.length;
  var last = film.turn[frames - 1];

  // differences to positions
  ["back", "front"].forEach(function (name) {
    film[name].forEach(function (rope) {
      for (var i = 2; i !== rope.path.length; i += 1) { rope.path[i] += rope.path[i - 2]; }
    });
  });
  var stops = film.stops.map(function (hex) {
    return [1, 3, 5].map(function (at) { return parseInt(hex.substr(at, 2), 16); });
  });
  function tensionColor(tension) {
    var range = film.tension_range;
    var share = Math.min(1, Math.max(0, (tension - range[0]) / (range[1] - range[0])));
    var place = share * (stops.length - 1);
    var below = Math.min(stops.length - 2, Math.floor(place));
    var rest = place - below;
    return "rgb(" + stops[below].map(function (c, i) {
      return Math.round(c + rest * (stops[below + 1][i] - c));
    }).join(",") + ")";
  }
  function blend(list, a, b, s) { return list[a] + s * (list[b] - list[a]); }
  function blendPoint(list, a, b, s) {
    return [0, 1].map(function (i) { return list[a][i] + s * (list[b][i] - list[a][i]); });
  }
  function cm(value) { return (value / 10).toFixed(1); }
  function degrees(dx, dy) { return Math.atan2(dy, dx) * 180 / Math.PI; }

  function drawRope(name, start, head, angle, a, b, s) {
    var ra = film[name][a], rb = film[name][b];
    var count = Math.min(ra.tension.length, rb.tension.length);
    var cos = Math.cos(angle), sin = Math.sin(angle);
    var center = [cos * head[0] - sin * head[1], sin * head[0] + cos * head[1]];
    var anchor = [cos * head[2] - sin * head[3], sin * head[2] + cos * head[3]];
    var lines = get(name).getElementsByTagName("line");
    var x = start[0], y = start[1];
    var outer = [], inner = [];
    for (var i = 0; i !== Math.min(count + 1, lines.length); i += 1) {
      var end = i === count;
      var nx = end ? anchor[0] : ra.path[2 * i] + s * (rb.path[2 * i] - ra.path[2 * i]);
      var ny = end ? anchor[1] : ra.path[2 * i + 1] + s * (rb.path[2 * i + 1] - ra.path[2 * i + 1]);
      var line = lines[i];
      line.setAttribute("x1", cm(x)); line.setAttribute("y1", cm(-y));
      line.setAttribute("x2", cm(nx)); line.setAttribute("y2", cm(-ny));
      var joint = Math.min(i, count - 1);
      line.setAttribute("stroke", tensionColor(ra.tension[joint] + s * (rb.tension[joint] - ra.tension[joint])));
      if (!end) {
        var height = ra.contact[i] + s * (rb.contact[i] - ra.contact[i]);
        if (height > 0 || outer.length) {
          var dx = nx - center[0], dy = ny - center[1];
          var reach = 1 + height / Math.max(1, Math.hypot(dx, dy));
          outer.push(cm(center[0] + reach * dx) + "," + cm(-center[1] - reach * dy));
          inner.push(cm(nx) + "," + cm(-ny));
        }
      }
      x = nx; y = ny;
    }
    var path = outer.length ? "M" + outer.join("L") + "L" + inner.reverse().join("L") + "Z" : "M0,0";
    get(name + "-contact").setAttribute("d", path);
  }

  function show(turn) {
    var b = 0;
    while (film.turn[b] !== undefined && turn > film.turn[b]) { b += 1; }
    b = Math.min(b, frames - 1);
    var a = Math.max(0, b - 1);
    var span = film.turn[b] - film.turn[a];
    var s = span > 0 ? Math.min(1, Math.max(0, (turn - film.turn[a]) / span)) : 0;
    var beam = blend(film.beam, a, b, s);
    var pin = blendPoint(film.pin, a, b, s);
    var end = blendPoint(film.crossbeam, a, b, s);
    var hook = blendPoint(film.suspension, a, b, s);
    get("beam").setAttribute("transform", "rotate(" + (-beam).toFixed(3) + ")");
    var c = film.crank;
    get("crank").setAttribute("transform", "translate(" + cm(c[0]) + "," + cm(-c[1]) + ") rotate(" +
      (-degrees(pin[0] - c[0], pin[1] - c[1])).toFixed(3) + ")");
    get("rod").setAttribute("transform", "translate(" + cm(pin[0]) + "," + cm(-pin[1]) + ") rotate(" +
      (-degrees(end[0] - pin[0], end[1] - pin[1])).toFixed(3) + ")");
    get("suspension").setAttribute("transform", "translate(" + cm(hook[0]) + "," + cm(-hook[1]) + ")");
    var rod = get("polished-rod");
    rod.setAttribute("x1", cm(hook[0])); rod.setAttribute("x2", cm(hook[0]));
    rod.setAttribute("y1", cm(-hook[1]));
    var angle = beam * Math.PI / 180;
    drawRope("back", end, film.back_head, angle, a, b, s);
    drawRope("front", hook, film.front_head, angle, a, b, s);
    film.readouts.forEach(function (readout, index) {
      var u = readout.values[a], v = readout.values[b];
      var known = typeof u === "number" && typeof v === "number";
      get("value-" + index).textContent =
        known ? (u + s * (v - u)).toFixed(readout.decimals).replace("-", "\u2212") : "\u2013";
    });
    get("cursor").style.left = (turn / 3.6).toFixed(3) + "%";
  }

  var slider = get("turn"), button = get("play"), speed = get("speed");
  slider.max = String(last);
  var playing = false, before = null, turn = 0;
  function step(now) {
    // a drawing that was replaced stops
    if (!playing || !slider.isConnected) { return; }
    if (before !== null) {
      turn += (now - before) / 1000 / film.seconds_per_deg * Number(speed.value);
      // a whole revolution runs on; a failed one starts again
      if (turn > last) { turn = last > 0 ? turn % last : 0; }
      slider.value = String(turn);
      show(turn);
    }
    before = now;
    requestAnimationFrame(step);
  }
  button.addEventListener("click", function () {
    playing = !playing; before = null;
    button.textContent = playing ? "Pause" : "Play";
    if (playing) { requestAnimationFrame(step); }
  });
  slider.addEventListener("input", function () { turn = Number(slider.value); show(turn); });
  show(0);
});
