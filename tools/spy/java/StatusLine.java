package houghstream.spy;

import java.awt.Color;
import javax.swing.BorderFactory;
import javax.swing.JLabel;

/** The line below a viewer: what is shown, or in orange what is wrong with it. */
@SuppressWarnings("serial")
final class StatusLine extends JLabel {
  private static final Color WRONG = new Color(200, 80, 0);

  StatusLine(String text) {
    super(text);
    setBorder(BorderFactory.createEmptyBorder(4, 8, 4, 8));
  }

  void say(String text, String complaint) {
    setForeground(complaint.isEmpty() ? Color.BLACK : WRONG);
    setText(complaint.isEmpty() ? text : text.isEmpty() ? complaint : text + " - " + complaint);
    setToolTipText(getText());
  }
}
