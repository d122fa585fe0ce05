// SPDX-License-Identifier: Apache-2.0
// A table that is wider than the screen is set smaller; where that is not enough it becomes a list of rows, in which each
// cell tells its column's name (site.css).
function fitTables() {
  for (const table of document.querySelectorAll("article table.docutils")) {
    const names = [...table.querySelectorAll("thead th")].map((cell) => cell.textContent);
    for (const row of table.querySelectorAll("tbody tr"))
      [...row.children].forEach((cell, column) => {
        cell.setAttribute("data-name", names[column] || "");
        cell.toggleAttribute("data-empty", !cell.textContent.trim());
      });
    const room = table.closest(".table-wrapper") || table.parentElement;
    const tooWide = () => Math.max(table.scrollWidth, room.scrollWidth) > room.clientWidth + 1;
    table.classList.remove("as-cards", "tight");
    table.classList.toggle("tight", tooWide());
    if (tooWide()) table.classList.replace("tight", "as-cards");
  }
}
window.addEventListener("load", fitTables);
window.addEventListener("resize", fitTables);
