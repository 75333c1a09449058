// SPDX-License-Identifier: BSD-3-Clause
// Decodes every message of MCAP files by the schema of its channel.
//
// usage: node decode_all.mjs FILE.mcap...
import { readIndexed } from "./read_mcap.mjs";

for (const path of process.argv.slice(2)) {
  const file = await readIndexed(path);
  let messages = 0;
  const types = new Set();
  for (const topic of file.topics.values()) {
    messages += topic.messages.length;
    types.add(topic.schema?.name);
  }
  if (messages === 0) throw new Error(`${path}: no messages`);
  console.log(`${path}: ${messages} messages of ${types.size} types decoded`);
}
