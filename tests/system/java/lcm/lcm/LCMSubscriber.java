package lcm.lcm;

public interface LCMSubscriber {
  void messageReceived(LCM lcm, String channel, LCMDataInputStream in);
}
