"""One module a scene; each has build(), which returns the files of its rig by name."""
