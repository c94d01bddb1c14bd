"""Many files at once: `python -m spectral_conformal batch`. Alone in reaching processes and network."""
