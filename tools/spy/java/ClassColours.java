package houghstream.spy;

import java.awt.Color;

/** The colour of a class, the same as in hs-view: eight that stay apart for colour-blind eyes (Okabe and Ito 2008). */
final class ClassColours {
  private static final int[] COLOURS = {0xE69F00, 0x56B4E9, 0x009E73, 0xF0E442, 0x0072B2, 0xD55E00, 0xCC79A7, 0xFFFFFF};

  private ClassColours() {}

  static Color of(int classId) {
    return new Color(COLOURS[Math.floorMod(classId - 1, COLOURS.length)]);
  }

  /** Black or white, whichever can be read on it. */
  static Color textOn(Color background) {
    double brightness = 0.299 * background.getRed() + 0.587 * background.getGreen() + 0.114 * background.getBlue();
    return brightness > 130 ? Color.BLACK : Color.WHITE;
  }
}
