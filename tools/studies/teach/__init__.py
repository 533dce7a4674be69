"""tools/bench teach: objects shown to a rendered camera, taught, and compared with the truth."""
