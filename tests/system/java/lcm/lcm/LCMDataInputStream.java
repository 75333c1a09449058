// SPDX-License-Identifier: BSD-3-Clause
package lcm.lcm;

import java.io.ByteArrayInputStream;
import java.io.DataInputStream;

public class LCMDataInputStream extends DataInputStream {
  public LCMDataInputStream(byte[] data) {
    super(new ByteArrayInputStream(data));
  }
}
