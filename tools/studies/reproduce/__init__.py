"""tools/reproduce: the comparison of the paper (Haensch, Kaiser, Hellwich, VISAPP 2017), repeated."""
