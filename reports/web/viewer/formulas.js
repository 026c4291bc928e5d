// The formulas of the course's modes, as MathML: the same in every language.

const row = (...parts) => `<mrow>${parts.join("")}</mrow>`;
const i = (name) => `<mi>${name}</mi>`;
const n = (number) => `<mn>${number}</mn>`;
const o = (operator) => `<mo>${operator}</mo>`;
const sub = (a, b) => `<msub>${a}${b}</msub>`;
const sup = (a, b) => `<msup>${a}${b}</msup>`;
const over = (a, b) => `<mfrac>${row(a)}${row(b)}</mfrac>`;
const vec = (name) => `<mi mathvariant="normal" class="cv-vector">${name}</mi>`;
const thin = `<mspace width="0.17em"></mspace>`;
const math = (...parts) => `<math display="block">${parts.join("")}</math>`;
// Formulas that belong together: beside each other, and below each other on a narrow page. No browser breaks one itself.
const also = `</math><math display="block">`;

const free = math(i("x"), o("("), i("t"), o(")"), o("="), sub(i("x"), n(0)), o("+"), sub(i("v"), i("x")), i("t"), also, sub(i("v"), i("x")), o("→"), o("−"), sub(i("v"), i("x")));
const pairs = math(over(row(i("n"), o("("), i("n"), o("−"), n(1), o(")")), n(2)), also,
  o("|"), sub(vec("x"), n(1)), o("−"), sub(vec("x"), n(2)), o("|"), o("≤"), sub(i("r"), n(1)), o("+"), sub(i("r"), n(2)));
const tree = math(i("O"), o("("), i("n"), thin, i("log"), thin, i("n"), o(")"), o("≪"), over(row(i("n"), o("("), i("n"), o("−"), n(1), o(")")), n(2)));
const impulse = math(i("J"), o("="), o("−"), over(row(n(1), o("+"), i("e")), row(n(1), o("/"), sub(i("m"), n(1)), o("+"), n(1), o("/"), sub(i("m"), n(2)))),
  o("("), sub(vec("v"), n(1)), o("−"), sub(vec("v"), n(2)), o(")"), o("·"), vec("n"), also,
  i("Δ"), sub(vec("v"), n(1)), o("="), over(i("J"), sub(i("m"), n(1))), vec("n"), also,
  i("Δ"), sub(vec("v"), n(2)), o("="), o("−"), over(i("J"), sub(i("m"), n(2))), vec("n"));
const barrier = math(i("T"), o("="), over(n(1), row(n(1), o("+"), over(row(sup(i("V"), n(2)), sup(i("sinh"), n(2)), o("("), i("κ"), i("a"), o(")")),
  row(n(4), i("E"), o("("), i("V"), o("−"), i("E"), o(")"))))), also,
  i("κ"), o("="), over(`<msqrt>${row(n(2), i("m"), o("("), i("V"), o("−"), i("E"), o(")"))}</msqrt>`, i("ħ")));
const slab = math(i("v"), i("Δ"), i("t"), o("&gt;"), i("a"), o("+"), n(2), i("r"));
const velocity = math(vec("v"), o("="), over(row(i("d"), vec("x")), row(i("d"), i("t"))));
const effet = math(o("|"), sub(vec("J"), i("t")), o("|"), o("≤"), i("μ"), sub(i("J"), i("n")), also,
  i("I"), i("Δ"), vec("ω"), o("="), i("r"), vec("n"), o("×"), sub(vec("J"), i("t")));

export const formulas = {
  "course/normal-mode": free,
  "course/brute-force": pairs,
  "course/quadtree": tree,
  "course/octree": tree,
  "course/impulse": impulse,
  "course/quantum-barrier": barrier,
  "course/thin-slab": slab,
  "course/velocity-arrows": velocity,
  "course/effet": effet,
};
