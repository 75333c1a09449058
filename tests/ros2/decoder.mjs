// SPDX-License-Identifier: BSD-3-Clause
// Decodes messages of ROS 2 with the reference libraries.
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";

/** A decoder of the messages of a schema, which refuses one whose encoding by the reference library differs. */
export function decoderOf(schema) {
  const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
  const reader = new MessageReader(definitions);
  const writer = new MessageWriter(definitions);
  return (data) => {
    const message = reader.readMessage(data);
    const again = writer.writeMessage(message);
    if (Buffer.compare(Buffer.from(again), Buffer.from(data)) !== 0) {
      throw new Error(`${schema.name}: the reference library encodes ${again.length} other bytes than ${data.length}`);
    }
    return message;
  };
}
