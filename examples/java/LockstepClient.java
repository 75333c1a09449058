// SPDX-License-Identifier: BSD-3-Clause
// A client in lockstep with the simulator, over a network that may lose messages, in Java:
// docs/develop/lockstep_protocol.md.
// Drives rover1 of worlds/minimal.yaml towards the wall, and stops before it.
//
//     lcm-gen --java --jpath types messages/*/*.lcm
//     javac -cp lcm.jar:types examples/java/LockstepClient.java -d .
//     java -cp lcm.jar:types:. LockstepClient
import java.io.IOException;
import java.nio.charset.StandardCharsets;
import java.security.GeneralSecurityException;
import java.security.SecureRandom;
import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.HexFormat;
import java.util.List;
import java.util.Map;
import java.util.concurrent.LinkedBlockingQueue;
import java.util.concurrent.TimeUnit;
import java.util.function.Consumer;
import java.util.function.LongConsumer;
import java.util.zip.CRC32;
import javax.crypto.Mac;
import javax.crypto.spec.SecretKeySpec;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMEncodable;
import lcm.lcm.LCMSubscriber;
import lcm.lcm.LCMDataOutputStream;
import shoal.planar_lidar_t;
import shoal.sim_ack_t;
import shoal.sim_control_reply_t;
import shoal.sim_control_request_t;
import shoal.sim_due_t;
import shoal.sim_payload_t;
import shoal.sim_resend_t;
import shoal.sim_resent_t;
import shoal.sim_signed_t;
import shoal.sim_tick_t;
import shoal.twist_command_t;

public class LockstepClient implements LCMSubscriber {
  record Message(String channel, byte[] data) {}

  private static final long SILENCE_S = 600;

  /// Signs requests that control a run, with the key in SHOAL_RUN_KEY: docs/guides/access_control.md.
  static class Signer {
    private final String name;
    private final String key = System.getenv().getOrDefault("SHOAL_RUN_KEY", "");
    private final long session = new SecureRandom().nextLong() >>> 1;
    private long counter = 1000 * System.currentTimeMillis();

    Signer(String name) {
      this.name = name;
    }

    /// Returns the payload to publish instead of `data`.
    byte[] sign(String channel, byte[] data) throws IOException {
      if (key.isEmpty()) return data;
      sim_signed_t signed = new sim_signed_t();
      signed.session = session;
      signed.sender = name;
      signed.counter = ++counter;
      signed.size = data.length;
      signed.content = data;
      signed.mac = new byte[32];
      byte[] payload = bytesOf(signed);
      int before = payload.length - 32;
      try {
        Mac mac = Mac.getInstance("HmacSHA256");
        mac.init(new SecretKeySpec(HexFormat.of().parseHex(key), "HmacSHA256"));
        mac.update((channel + "\0").getBytes(StandardCharsets.UTF_8));
        mac.update(payload, 0, before);
        mac.doFinal(payload, before);
      } catch (GeneralSecurityException error) {
        throw new IOException(error);
      }
      return payload;
    }
  }

  private final LCM lcm = new LCM();
  private final Signer signer;
  private final String name;
  private final long session = 1 + (long) (Math.random() * (1L << 52));
  private final int id = (int) (session & 0x7fffffff); // of the request
  private final LinkedBlockingQueue<Message> arrived = new LinkedBlockingQueue<>();
  private final List<String> receives = new ArrayList<>();
  private final Map<String, Consumer<byte[]>> handlers = new HashMap<>();
  private final Map<String, ArrayDeque<byte[]>> held = new HashMap<>();
  private final List<Message> published = new ArrayList<>();
  private sim_tick_t tick; // waits for messages
  private sim_due_t due;
  private byte[][] messages;
  private long sequence; // of the last tick that was handled
  private int branch;
  private sim_ack_t ack = new sim_ack_t(); // before the first tick it only reports that the client is alive
  private boolean joined, over;

  public LockstepClient(String name) throws IOException {
    this.name = name;
    signer = new Signer(name);
    ack.client = name;
    ack.session = session;
    ack.listed = true;
    ack.channel = new String[0];
    ack.crc = new long[0];
    for (String channel : List.of("sim.control.reply", "sim.tick", "sim.resend", "sim.resent"))
      lcm.subscribe(channel.replace(".", "\\."), this);
  }

  /// Called by LCM in its own thread.
  @Override
  public void messageReceived(LCM from, String channel, LCMDataInputStream in) {
    try {
      byte[] data = new byte[in.available()];
      in.readFully(data);
      arrived.add(new Message(channel, data));
    } catch (IOException error) {
      // Ignore the message.
    }
  }

  public void subscribe(String channel, Consumer<byte[]> handler) {
    receives.add(channel);
    handlers.put(channel, handler);
    held.put(channel, new ArrayDeque<>());
    lcm.subscribe(channel.replace(".", "\\."), this);
  }

  public void publish(String channel, LCMEncodable message) throws IOException {
    byte[] data = bytesOf(message);
    published.add(new Message(channel, data));
    lcm.publish(channel, data, 0, data.length);
  }

  private void send(String channel, LCMEncodable message) throws IOException {
    byte[] data = signer.sign(channel, bytesOf(message));
    lcm.publish(channel, data, 0, data.length);
  }

  /// Joins, and calls `decide` with the time at each tick, after the handlers of all messages.
  public void run(double periodS, LongConsumer decide) throws IOException, InterruptedException {
    while (!joined) { // the simulator may start later than the client
      sim_control_request_t request = new sim_control_request_t();
      request.id = id;
      request.client = name;
      request.command = "join";
      request.value = periodS;
      request.text = "{session: " + session + ", receives: ['" + String.join("', '", receives) + "']}";
      send("sim.control", request);
      long again = System.nanoTime() + 200_000_000;
      for (long left = 200_000_000; !joined && left > 0; left = again - System.nanoTime())
        take(arrived.poll(left, TimeUnit.NANOSECONDS));
    }
    held.values().forEach(ArrayDeque::clear); // addressed to a client before it joined the lockstep
    long pauseMs = 1;
    long received = System.nanoTime();
    while (!over) {
      Message message = arrived.poll(tick == null ? 1000 : pauseMs, TimeUnit.MILLISECONDS);
      take(message);
      if (message != null) received = System.nanoTime();
      if (System.nanoTime() - received > SILENCE_S * 1_000_000_000L)
        throw new IllegalStateException("the simulator fell silent");
      if (message == null && tick != null) {
        send_request();
        pauseMs = Math.min(Math.max(20, 2 * pauseMs), 250);
      }
      if (tick != null && hasAll()) {
        handle(decide);
        pauseMs = 1;
      }
    }
  }

  private void take(Message message) throws IOException {
    if (message == null) return;
    try {
      takeValid(message);
    } catch (IOException | IndexOutOfBoundsException | NegativeArraySizeException error) {
      // Any program may publish anything: messages of another type are ignored.
      System.err.println(message.channel() + ": " + error + " (ignored)");
    }
  }

  private void takeValid(Message message) throws IOException {
    switch (message.channel()) {
      case "sim.control.reply" -> onReply(new sim_control_reply_t(message.data()));
      case "sim.tick" -> onTick(new sim_tick_t(message.data()));
      case "sim.resend" -> onResend(new sim_resend_t(message.data()));
      case "sim.resent" -> onResent(new sim_resent_t(message.data()));
      default -> {
        ArrayDeque<byte[]> waiting = held.get(message.channel());
        waiting.add(message.data());
        if (waiting.size() > 10_000) waiting.remove(); // if a tick lists it, it is requested
      }
    }
  }

  private void onReply(sim_control_reply_t reply) {
    if (!reply.client.equals(name) || reply.id != id) return;
    // A reply to an unreadable request has no session; other clients of the same name have another one.
    if (reply.session != session && (joined || reply.session != 0)) return;
    if (!reply.ok) throw new IllegalStateException(reply.text);
    joined = true;
  }

  private void onTick(sim_tick_t next) throws IOException {
    for (sim_due_t each : next.client) {
      if (!each.name.equals(name) || each.session != session) continue;
      if (each.sequence == sequence) {
        send("sim.ack", ack); // the answer was lost, or the simulator checks whether the client is alive
      } else if (each.sequence > (tick == null ? sequence : due.sequence)) { // replaces an older one
        if (next.branch != branch && sequence > 0) throw new IllegalStateException("the world went back in time");
        for (int channel : each.channel)
          if (channel < 0 || channel >= receives.size()) return; // not a requested message
        branch = next.branch;
        tick = next;
        due = each;
        messages = new byte[each.count][];
      }
      return;
    }
    // The client is not listed: the last tick of another run does not matter either.
  }

  private boolean hasAll() {
    boolean all = true;
    for (int i = 0; i < due.count; ++i) {
      if (messages[i] != null) continue;
      ArrayDeque<byte[]> waiting = held.get(receives.get(due.channel[i]));
      for (byte[] data : waiting)
        if (crcOf(data) == due.crc[i]) {
          messages[i] = data;
          waiting.remove(data); // this very array
          break;
        }
      all = all && messages[i] != null;
    }
    return all;
  }

  private void send_request() throws IOException {
    sim_resend_t question = new sim_resend_t();
    question.client = name;
    question.session = session;
    question.sequence = due.sequence;
    while (messages[question.first] != null) ++question.first;
    send("sim.resend", question);
  }

  private void onResent(sim_resent_t bundle) {
    if (tick == null || bundle.of_client || bundle.session != session || bundle.sequence != due.sequence) return;
    for (int i = 0; i < bundle.count; ++i)
      if (crcOf(bundle.message[i].data) == due.crc[bundle.first + i]) messages[bundle.first + i] = bundle.message[i].data;
  }

  private void handle(LongConsumer decide) throws IOException {
    sim_tick_t now = tick;
    tick = null;
    sequence = due.sequence;
    published.clear();
    for (int i = 0; i < due.count; ++i) handlers.get(receives.get(due.channel[i])).accept(messages[i]);
    over = now.last;
    if (!over) decide.accept(now.utime);
    ack = new sim_ack_t();
    ack.utime = now.utime;
    ack.step = now.step;
    ack.client = name;
    ack.session = session;
    ack.sequence = sequence;
    ack.listed = true;
    ack.count = published.size();
    ack.channel = published.stream().map(Message::channel).toArray(String[]::new);
    ack.crc = published.stream().mapToLong(each -> crcOf(each.data())).toArray();
    send("sim.ack", ack);
  }

  private void onResend(sim_resend_t question) throws IOException {
    if (!question.of_client || question.session != session || question.sequence != sequence) return;
    for (int i = Math.max(0, question.first); i < published.size(); ++i) {
      sim_payload_t message = new sim_payload_t();
      message.channel = published.get(i).channel();
      message.data = published.get(i).data();
      message.size = message.data.length;
      sim_resent_t bundle = new sim_resent_t();
      bundle.client = name;
      bundle.session = session;
      bundle.sequence = sequence;
      bundle.of_client = true;
      bundle.first = i;
      bundle.count = 1;
      bundle.message = new sim_payload_t[] {message};
      send("sim.resent", bundle);
    }
  }

  private static long crcOf(byte[] data) {
    CRC32 crc = new CRC32();
    crc.update(data);
    return crc.getValue();
  }

  private static byte[] bytesOf(LCMEncodable message) throws IOException {
    LCMDataOutputStream out = new LCMDataOutputStream();
    message.encode(out);
    return out.toByteArray();
  }

  public static void main(String[] arguments) throws Exception {
    LockstepClient client = new LockstepClient("pilot");
    double[] aheadM = {0};
    client.subscribe("rover1.lidar", data -> {
      try {
        planar_lidar_t scan = new planar_lidar_t(data);
        aheadM[0] = scan.ranges[scan.nranges / 2];
      } catch (IOException error) {
        System.err.println("rover1.lidar: " + error.getMessage());
      }
    });
    client.run(0.1, utime -> {
      twist_command_t command = new twist_command_t();
      command.utime = utime;
      command.forward_mps = aheadM[0] > 1.0 ? 0.5 : 0.0;
      try {
        client.publish("rover1.drive.cmd", command);
      } catch (IOException error) {
        throw new IllegalStateException(error);
      }
    });
    System.out.printf("the run is over, %.2f m before the wall%n", aheadM[0]);
    System.exit(0); // the thread of LCM would continue
  }
}
