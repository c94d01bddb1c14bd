"""Many files at once: `python -m spectral_conformal batch`. Only this package uses processes and the network."""
