// SPDX-License-Identifier: BSD-3-Clause
package lcm.lcm;

public interface LCMSubscriber {
  void messageReceived(LCM lcm, String channel, LCMDataInputStream in);
}
