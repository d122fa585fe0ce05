// SPDX-License-Identifier: Apache-2.0
// A button on each block of code that copies its text.
window.addEventListener("DOMContentLoaded", () => {
  for (const block of document.querySelectorAll("article div.highlight")) {
    const code = block.querySelector("pre").textContent;
    const button = Object.assign(document.createElement("button"), { type: "button", className: "copy" });
    const name = (text) => (button.textContent = text);
    name("Copy");
    button.addEventListener("click", async () => {
      await navigator.clipboard.writeText(code).then(() => name("Copied"), () => name("Not allowed"));
      setTimeout(name, 1500, "Copy");
    });
    block.append(button);
  }
});
