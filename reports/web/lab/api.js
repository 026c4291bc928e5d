// What the lab's server answers (carom lab). Bad input is answered with the message of the command line.

async function ask(path, body) {
  const answer = await fetch(path, body === undefined ? {} : {
    method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
  const json = await answer.json().catch(() => ({ error: `${path}: ${answer.status} ${answer.statusText}` }));
  if (!answer.ok) throw new Error(json.error ?? `${path}: ${answer.status}`);
  return json;
}

export const api = {
  /** [{id, title, about, dimension}, …], those of the course first */
  modes: () => ask("api/modes"),
  /** [{label, name, profile, …}, …]: the label is name or name@profile */
  engines: () => ask("api/engines"),
  /** {toml} */
  scene: (id) => ask(`api/scene?id=${encodeURIComponent(id)}`),
  /** {toml, engines, law} → a playback */
  run: (request) => ask("api/run", request),
  /** {law} → what it keeps and breaks */
  law: (law) => ask("api/law", { law }),
  /** {toml, event} → {toml} with the event in it */
  withEvent: (toml, event) => ask("api/toml", { toml, event }),
};
