// SPDX-License-Identifier: BSD-3-Clause
// A stand-in for LCM's Java classes, with what examples/java needs to compile; it sends nothing.
package lcm.lcm;

import java.io.IOException;

public class LCM {
  public LCM(String... urls) throws IOException {}

  public void publish(String channel, LCMEncodable message) throws IOException {}

  public void publish(String channel, byte[] data, int offset, int length) throws IOException {}

  public void subscribe(String expression, LCMSubscriber subscriber) {}
}
