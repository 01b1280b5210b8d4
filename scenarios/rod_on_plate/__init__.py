"""A rod of SPH particles strikes a plate of finite elements in contact: scene."""
