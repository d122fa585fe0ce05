// SPDX-License-Identifier: Apache-2.0
// A table that is wider than the screen becomes a list of rows: each cell then tells its column's name (site.css).
function fitTables() {
  for (const table of document.querySelectorAll("article table.docutils")) {
    const names = [...table.querySelectorAll("thead th")].map((cell) => cell.textContent);
    for (const row of table.querySelectorAll("tbody tr"))
      [...row.children].forEach((cell, column) => cell.setAttribute("data-name", names[column] || ""));
    table.classList.remove("as-cards");
    const room = table.closest(".table-wrapper") || table.parentElement;
    table.classList.toggle("as-cards", table.scrollWidth > room.clientWidth + 1);
  }
}
window.addEventListener("load", fitTables);
window.addEventListener("resize", fitTables);
