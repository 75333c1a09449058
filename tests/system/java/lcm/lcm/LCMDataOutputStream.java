// SPDX-License-Identifier: BSD-3-Clause
package lcm.lcm;

import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;

public class LCMDataOutputStream extends DataOutputStream {
  public LCMDataOutputStream() {
    super(new ByteArrayOutputStream());
  }

  public byte[] toByteArray() {
    return ((ByteArrayOutputStream) out).toByteArray();
  }
}
