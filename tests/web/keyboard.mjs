// A page as people come to it who have no mouse, or do not see it: by Tab, and by the tree that a screen reader reads.

const kMost = 200; // more than any page here has

/** In the page: what a keyboard must reach. Of radio buttons of one name it reaches the chosen one, and goes on by arrows. */
function listReachable() {
  return [...document.querySelectorAll("a[href], button, select, input, textarea, summary, canvas[role], [tabindex]")]
    .filter((each) => each.checkVisibility() && !each.disabled && each.getAttribute("role") !== "img" && (each.type !== "radio" || each.checked));
}

/** Goes through the whole page. @returns names of what is there, of what Tab and Shift+Tab came by, and of what looked no different then */
export async function walk(page, first) {
  await page.evaluate(`globalThis.walked = (() => {
    const there = (${listReachable})();
    const name = (each) => each.tagName + "." + each.className + there.indexOf(each);
    const look = ({ outlineStyle, outlineWidth, outlineColor, boxShadow }) => [outlineStyle, outlineWidth, outlineColor, boxShadow].join();
    document.activeElement.blur();
    const before = new Map(there.map((each) => [each, look(getComputedStyle(each))]));
    const walked = { there: there.map(name), came: [], unseen: [] };
    walked.listener = ({ target }) => {
      walked.came.push(name(target));
      if (look(getComputedStyle(target)) === before.get(target)) walked.unseen.push(name(target));
    };
    document.addEventListener("focusin", walked.listener);
    return walked;
  })()`);
  await page.locator(first).focus();
  const away = () => page.evaluate(() => document.activeElement === document.body);
  const go = async (key) => {
    for (let k = 0; k < kMost; k += 1) {
      await page.keyboard.press(key);
      if (await away()) break;
    }
    return page.evaluate(() => globalThis.walked.came.splice(0));
  };
  const forth = await go("Tab");
  const back = await go("Shift+Tab");
  return page.evaluate(([forth, back]) => {
    document.removeEventListener("focusin", globalThis.walked.listener);
    const { there, unseen } = globalThis.walked;
    return { there, unseen, forth, back };
  }, [forth, back]);
}

/** Presses Tab until the focus is on what the selector finds. */
export async function tabTo(page, selector, key = "Tab") {
  const wanted = await page.locator(selector).first().elementHandle();
  for (let k = 0; k < kMost; k += 1) {
    if (await page.evaluate((element) => document.activeElement === element, wanted)) return;
    await page.keyboard.press(key);
  }
  throw new Error(`${key} never comes to ${selector}`);
}

/** What a screen reader can come to: role and name of each focusable node. */
export async function told(page) {
  const session = await page.context().newCDPSession(page);
  const { nodes } = await session.send("Accessibility.getFullAXTree");
  await session.detach();
  return nodes.filter(({ ignored, properties }) => !ignored && properties?.some(({ name, value }) => name === "focusable" && value.value))
    .map(({ role, name }) => ({ role: role.value, name: name?.value ?? "" }));
}
