"""A small modelling library for the example rigs: meshes, shapes, pixels, and the two files that they become."""
