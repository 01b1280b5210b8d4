"""Waves on water of finite depth: theory, wave makers, absorption, damping zones."""
