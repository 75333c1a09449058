// SPDX-License-Identifier: BSD-3-Clause
package lcm.lcm;

import java.io.DataOutput;
import java.io.IOException;

public interface LCMEncodable {
  void encode(DataOutput out) throws IOException;
}
