/** An element with properties, attributes (those with a dash) and children. */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "role") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

export function button(className, action) {
  const element = make("button", { type: "button", className });
  element.addEventListener("click", action);
  return element;
}

/**
 * Remembers where in `root` the keyboard is. @returns what gives the focus to the element that stands there later, where
 * it went away with what was replaced
 */
export function keepFocus(root) {
  const held = document.activeElement;
  if (!held || held === root || !root.contains(held)) return () => {};
  const alike = ({ tagName, className, dataset: { name } }) => [tagName, className, name].join("|");
  const like_it = () => [...root.querySelectorAll(held.tagName)].filter((each) => alike(each) === alike(held));
  const place = like_it().indexOf(held);
  return () => {
    if (document.activeElement === document.body) like_it()[place]?.focus({ preventScroll: true });
  };
}

/** Whether the page is shown dark: as it was chosen, else as the system has it. */
export function isDark() {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

export function save(name, blob) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
