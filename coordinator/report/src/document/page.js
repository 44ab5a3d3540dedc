// Sorts and filters tables. In a page of the dashboard (`data-live`), also replaces sections as the run goes on.
var horsehead = { parts: [] };
(function () {
  "use strict";

  // tables -------------------------------------------------------------------------------------------------
  function value(row, column) {
    var cell = row.cells[column];
    return cell ? cell.dataset.value || cell.textContent.trim() : "";
  }
  function compare(a, b) {
    var x = Number(a), y = Number(b);
    var numbers = a !== "" && b !== "" && !isNaN(x) && !isNaN(y);
    // what has no number stands last among numbers
    if (!numbers && a !== "" && !isNaN(x)) { return -1; }
    if (!numbers && b !== "" && !isNaN(y)) { return 1; }
    return numbers ? x - y : a.localeCompare(b);
  }
  function sort(table, column, down) {
    var body = table.tBodies[0];
    var rows = Array.prototype.slice.call(body.rows);
    rows.sort(function (one, other) {
      var order = compare(value(one, column), value(other, column));
      return down ? -order : order;
    });
    rows.forEach(function (row) { body.appendChild(row); });
    Array.prototype.forEach.call(table.tHead.rows[0].cells, function (label, index) {
      label.setAttribute("aria-sort", index === column ? (down ? "descending" : "ascending") : "none");
    });
    table.dataset.sorted = column + (down ? " down" : " up");
  }
  // words must all occur in a row; NAME<NUMBER and NAME>NUMBER compare a column
  function filter(table, text) {
    var labels = Array.prototype.map.call(table.tHead.rows[0].cells, function (label) {
      return (label.dataset.name || label.textContent).trim().toLowerCase();
    });
    var tests = text.toLowerCase().split(/\s+/).filter(Boolean).map(function (word) {
      var limit = /^(.+?)([<>])(.+)$/.exec(word);
      var column = limit ? labels.indexOf(limit[1]) : -1;
      if (column < 0 || isNaN(Number(limit[3]))) {
        return function (row) { return row.textContent.toLowerCase().indexOf(word) >= 0; };
      }
      return function (row) {
        var own = value(row, column), number = Number(own);
        if (own === "" || isNaN(number)) { return false; }
        return limit[2] === "<" ? number < Number(limit[3]) : number > Number(limit[3]);
      };
    });
    var shown = 0;
    Array.prototype.forEach.call(table.tBodies[0].rows, function (row) {
      row.hidden = !tests.every(function (test) { return test(row); });
      shown += row.hidden ? 0 : 1;
    });
    var count = table.closest("figure").querySelector(".count");
    if (count) { count.textContent = shown + " of " + table.tBodies[0].rows.length + " rows"; }
  }
  function tables(part) {
    part.querySelectorAll("table[data-sortable]").forEach(function (table) {
      Array.prototype.forEach.call(table.tHead.rows[0].cells, function (label, column) {
        label.tabIndex = 0;
        function turn() { sort(table, column, label.getAttribute("aria-sort") === "ascending"); }
        label.addEventListener("click", turn);
        label.addEventListener("keydown", function (event) { if (event.key === "Enter") { turn(); } });
      });
      var input = table.closest("figure").querySelector("input[type=search]");
      if (input) {
        input.addEventListener("input", function () { filter(table, input.value); });
        filter(table, input.value);
      }
    });
  }

  function prepare(part) {
    tables(part);
    horsehead.parts.forEach(function (own) { own(part); });
  }

  // sections of a run that goes on ---------------------------------------------------------------------------
  // what the reader has opened, sorted, filtered or moved stays as it is when its section is replaced
  function keep(old) {
    var kept = { open: [], sorted: [], inputs: {}, active: null };
    old.querySelectorAll("details").forEach(function (one) { kept.open.push(one.open); });
    old.querySelectorAll("table[data-sortable]").forEach(function (one) { kept.sorted.push(one.dataset.sorted); });
    old.querySelectorAll("input[id], select[id]").forEach(function (one) { kept.inputs[one.id] = one.value; });
    if (old.contains(document.activeElement)) { kept.active = document.activeElement.id; }
    return kept;
  }
  function restore(section, kept) {
    section.querySelectorAll("details").forEach(function (one, index) { one.open = Boolean(kept.open[index]); });
    Object.keys(kept.inputs).forEach(function (id) {
      var input = section.querySelector("#" + CSS.escape(id));
      if (!input) { return; }
      input.value = kept.inputs[id];
      input.dispatchEvent(new Event("input"));
    });
    section.querySelectorAll("table[data-sortable]").forEach(function (one, index) {
      var order = (kept.sorted[index] || "").split(" ");
      if (order.length === 2) { sort(one, Number(order[0]), order[1] === "down"); }
    });
    var active = kept.active && section.querySelector("#" + CSS.escape(kept.active));
    if (active) { active.focus({ preventScroll: true }); }
  }
  function replace(id, text) {
    var template = document.createElement("template");
    template.innerHTML = text;
    var section = template.content.firstElementChild;
    var old = document.getElementById(id);
    if (old) {
      var kept = keep(old);
      old.replaceWith(section);
      prepare(section);
      restore(section, kept);
    } else {
      document.getElementById("sections").appendChild(section);
      prepare(section);
    }
  }
  function arrange(header) {
    document.title = header.title;
    document.getElementById("title").textContent = header.title;
    document.getElementById("run").textContent = header.run;
    document.getElementById("state").textContent = header.state;
    var contents = document.getElementById("contents");
    contents.textContent = "";
    var wanted = {};
    var before = null;
    header.sections.forEach(function (own) {
      wanted[own[0]] = true;
      var link = document.createElement("a");
      link.href = "#" + own[0];
      link.textContent = own[1];
      contents.appendChild(link);
      var section = document.getElementById(own[0]);
      if (section && before && before.nextElementSibling !== section) { before.after(section); }
      if (section && !before && section.previousElementSibling) { section.parentElement.prepend(section); }
      before = section || before;
    });
    document.querySelectorAll("#sections > section").forEach(function (section) {
      if (!wanted[section.id]) { section.remove(); }
    });
  }
  // a browser opens few connections to one server: a page that nobody sees gives its own back
  var source = null;
  function leave() {
    if (source) { source.close(); source = null; }
  }
  function follow() {
    leave();
    if (document.hidden) { return; }
    var lost = document.getElementById("lost");
    source = new EventSource("events?after=" + document.body.dataset.version);
    source.addEventListener("open", function () { lost.hidden = true; });
    source.addEventListener("error", function () {
      lost.hidden = false;
      // a refusal ends the source for good, where a broken connection is tried again by the browser
      if (source && source.readyState === EventSource.CLOSED) { setTimeout(follow, 2000); }
    });
    function received(event) {
      if (event.lastEventId) { document.body.dataset.version = event.lastEventId; }
    }
    source.addEventListener("section", function (event) {
      var section = JSON.parse(event.data);
      replace(section.id, section.html);
      received(event);
    });
    source.addEventListener("header", function (event) {
      arrange(JSON.parse(event.data));
      received(event);
    });
  }

  // a row of the table of individuals opens the curves of its individual
  function individuals() {
    document.addEventListener("click", function (event) {
      var row = event.target.closest("tr[data-individual]");
      if (!row) { return; }
      var place = document.getElementById("individual");
      place.textContent = "Individual " + row.dataset.individual + " is being simulated.";
      place.scrollIntoView({ block: "nearest" });
      fetch("individual/" + row.dataset.individual).then(function (answer) {
        return answer.text();
      }).then(function (text) {
        place.innerHTML = text;
      }, function () {
        place.textContent = "The dashboard does not answer.";
      });
    });
  }

  document.addEventListener("DOMContentLoaded", function () {
    prepare(document);
    if (document.body.dataset.live) {
      // the token is in a cookie by now, and need not stand in the address
      if (location.search) { history.replaceState(null, "", location.pathname + location.hash); }
      follow();
      document.addEventListener("visibilitychange", function () {
        if (document.hidden) { leave(); } else { follow(); }
      });
      individuals();
    }
  });
}());
